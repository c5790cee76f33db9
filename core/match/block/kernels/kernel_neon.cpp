// SPDX-License-Identifier: BSD-3-Clause
// Empty where the compiler was not told of NEON.
#if defined(__aarch64__) || defined(__ARM_NEON)
#include "core/match/block/kernels/kernel-inl.h"
#include "core/match/vector/vector_neon.h"

namespace stereod::kernels {

extern constexpr Kernel kNeonKernel = make_kernel<VectorNeon>();

}  // namespace stereod::kernels
#endif
