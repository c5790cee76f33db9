// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/semiglobal/kernels/kernel.h"

namespace stereod::semiglobal {

const Kernel& kernel_for(Isa isa) {
  switch (isa) {
#if defined(__x86_64__) || defined(__i386__)
    case Isa::kSsse3:
      return kSsse3Kernel;
    case Isa::kSse41:
      return kSse41Kernel;
    case Isa::kAvx2:
      return kAvx2Kernel;
#elif defined(__aarch64__) || defined(__ARM_NEON)
    case Isa::kNeon:
      return kNeonKernel;
#endif
    default:
      return kScalarKernel;
  }
}

}  // namespace stereod::semiglobal
