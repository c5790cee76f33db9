#include "core/match/kernels/kernel_template.h"
#include "core/match/kernels/vector_sse.h"

namespace stereod::kernels {

extern constexpr Kernel kSse41Kernel = make_kernel<VectorSse<true>>();

}  // namespace stereod::kernels
