// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/semiglobal/kernels/kernel-inl.h"
#include "core/match/vector/vector_avx2.h"

namespace stereod::semiglobal {

extern constexpr Kernel kAvx2Kernel = make_kernel<kernels::VectorAvx2>();

}  // namespace stereod::semiglobal
