#include "core/match/kernels/kernel_template.h"
#include "core/match/kernels/vector_avx2.h"

namespace stereod::kernels {

extern constexpr Kernel kAvx2Kernel = make_kernel<VectorAvx2>();

}  // namespace stereod::kernels
