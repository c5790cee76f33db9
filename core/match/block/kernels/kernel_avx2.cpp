// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/block/kernels/kernel-inl.h"
#include "core/match/vector/vector_avx2.h"

namespace stereod::kernels {

extern constexpr Kernel kAvx2Kernel = make_kernel<VectorAvx2>();

}  // namespace stereod::kernels
