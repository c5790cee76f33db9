// Empty where the compiler was not told of NEON.
#if defined(__aarch64__) || defined(__ARM_NEON)
#include "core/match/kernels/kernel_template.h"
#include "core/match/kernels/vector_neon.h"

namespace stereod::kernels {

extern constexpr Kernel kNeonKernel = make_kernel<VectorNeon>();

}  // namespace stereod::kernels
#endif
