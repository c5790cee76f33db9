// Empty where the compiler was not told of NEON.
#if defined(__aarch64__) || defined(__ARM_NEON)
#include "core/match/kernels/vector_neon.h"
#include "core/match/semiglobal/kernel_template.h"

namespace stereod::semiglobal {

extern constexpr Kernel kNeonKernel = make_kernel<kernels::VectorNeon>();

}  // namespace stereod::semiglobal
#endif
