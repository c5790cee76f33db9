#include "core/match/kernels/vector_sse.h"
#include "core/match/semiglobal/kernel_template.h"

namespace stereod::semiglobal {

extern constexpr Kernel kSse41Kernel = make_kernel<kernels::VectorSse<true>>();

}  // namespace stereod::semiglobal
