// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/block/prefilter.h"

#include "core/match/block/kernels/kernel.h"

namespace stereod {

void xsobel_row(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int width,
                int cap, std::uint8_t* out) noexcept {
  kernels::kScalarKernel.xsobel_row(above, row, below, width, cap, out);
}

}  // namespace stereod
