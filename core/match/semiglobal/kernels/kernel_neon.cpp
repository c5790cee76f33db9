// Empty where the compiler was not told of NEON.
#if defined(__aarch64__) || defined(__ARM_NEON)
#include "core/match/block/kernels/vector_neon.h"
#include "core/match/semiglobal/kernels/kernel-inl.h"

namespace stereod::semiglobal {

extern constexpr Kernel kNeonKernel = make_kernel<kernels::VectorNeon>();

}  // namespace stereod::semiglobal
#endif
