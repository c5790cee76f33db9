// SPDX-License-Identifier: BSD-3-Clause
// Source of the blending loop, which the compiler turns into vector code. Each file that includes it is
// compiled for one instruction set and passes a tag of its own, so that the linker keeps the instantiations
// apart.
#pragma once

#include "core/rectify/bilinear.h"

namespace stereod {

template <typename Tag>
void blend_row(const BlendRow& row, int count, std::uint8_t* __restrict out) {
  const std::uint8_t* __restrict top_left = row.top_left;
  const std::uint8_t* __restrict top_right = row.top_right;
  const std::uint8_t* __restrict bottom_left = row.bottom_left;
  const std::uint8_t* __restrict bottom_right = row.bottom_right;
  const std::uint8_t* __restrict across = row.across;
  const std::uint8_t* __restrict down = row.down;
  for (int i = 0; i < count; ++i) {
    // Exact in 16 bits: with t, b the means of the upper and lower row [1/128 gray levels], the result is
    // floor((t/4 + 16 + floor((b − t) · down/128)) / 32), and the inner floor is the upper half of a product.
    const auto part = static_cast<std::int16_t>(across[i]);
    const auto top = static_cast<std::int16_t>(128 * top_left[i] + (top_right[i] - top_left[i]) * part);
    const auto bottom =
        static_cast<std::int16_t>(128 * bottom_left[i] + (bottom_right[i] - bottom_left[i]) * part);
    const auto apart = static_cast<std::int16_t>(bottom - top);
    const auto weight = static_cast<std::int16_t>(down[i] << 9);
    const auto change = static_cast<std::int16_t>((static_cast<std::int32_t>(apart) * weight) >> 16);
    out[i] = static_cast<std::uint8_t>(((top >> 2) + 16 + change) >> 5);
  }
}

}  // namespace stereod
