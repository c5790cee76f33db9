// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/block/kernels/kernel-inl.h"
#include "core/match/vector/vector_scalar.h"

namespace stereod::kernels {

extern constexpr Kernel kScalarKernel = make_kernel<VectorScalar>();

}  // namespace stereod::kernels
