// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/block/kernels/kernel-inl.h"
#include "core/match/vector/vector_sse.h"

namespace stereod::kernels {

extern constexpr Kernel kSse41Kernel = make_kernel<VectorSse<true>>();

}  // namespace stereod::kernels
