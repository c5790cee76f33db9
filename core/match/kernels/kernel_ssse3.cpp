#include "core/match/kernels/kernel_template.h"
#include "core/match/kernels/vector_sse.h"

namespace stereod::kernels {

extern constexpr Kernel kSsse3Kernel = make_kernel<VectorSse<false>>();

}  // namespace stereod::kernels
