// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/semiglobal/kernels/kernel-inl.h"
#include "core/match/vector/vector_scalar.h"

namespace stereod::semiglobal {

extern constexpr Kernel kScalarKernel = make_kernel<kernels::VectorScalar>();

}  // namespace stereod::semiglobal
