#include "core/match/block/kernels/vector_avx2.h"
#include "core/match/semiglobal/kernels/kernel-inl.h"

namespace stereod::semiglobal {

extern constexpr Kernel kAvx2Kernel = make_kernel<kernels::VectorAvx2>();

}  // namespace stereod::semiglobal
