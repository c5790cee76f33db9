// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/semiglobal/kernels/kernel-inl.h"
#include "core/match/vector/vector_sse.h"

namespace stereod::semiglobal {

extern constexpr Kernel kSsse3Kernel = make_kernel<kernels::VectorSse<false>>();

}  // namespace stereod::semiglobal
