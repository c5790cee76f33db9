#include "core/match/kernels/vector_sse.h"
#include "core/match/semiglobal/kernel_template.h"

namespace stereod::semiglobal {

extern constexpr Kernel kSsse3Kernel = make_kernel<kernels::VectorSse<false>>();

}  // namespace stereod::semiglobal
