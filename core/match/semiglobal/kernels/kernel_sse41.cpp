#include "core/match/block/kernels/vector_sse.h"
#include "core/match/semiglobal/kernels/kernel-inl.h"

namespace stereod::semiglobal {

extern constexpr Kernel kSse41Kernel = make_kernel<kernels::VectorSse<true>>();

}  // namespace stereod::semiglobal
