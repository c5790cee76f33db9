// SPDX-License-Identifier: BSD-3-Clause
// Empty where the compiler was not told of NEON.
#if defined(__aarch64__) || defined(__ARM_NEON)
#include "core/match/semiglobal/kernels/kernel-inl.h"
#include "core/match/vector/vector_neon.h"

namespace stereod::semiglobal {

extern constexpr Kernel kNeonKernel = make_kernel<kernels::VectorNeon>();

}  // namespace stereod::semiglobal
#endif
