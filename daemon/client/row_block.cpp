// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/client/row_block.h"

#include <limits>

namespace stereod {

bool RowBlock::is_filled(int x, int y) const {
  if (!has_filled()) return false;
  const auto row_bytes = static_cast<std::size_t>((message_.width + 7) / 8);
  const std::size_t index =
      static_cast<std::size_t>(y - message_.first_row) * row_bytes + static_cast<std::size_t>(x / 8);
  return (message_.filled[index] >> (x % 8) & 1) != 0;
}

std::int16_t RowBlock::at(int x, int y, Pixels pixels) const {
  if (pixels == Pixels::kMeasured && is_filled(x, y)) return DisparityMap::kNone;
  const auto index =
      static_cast<std::size_t>(y - message_.first_row) * static_cast<std::size_t>(message_.width) +
      static_cast<std::size_t>(x);
  const std::uint8_t* in = message_.data.data() + index * static_cast<std::size_t>(message_.bytes_per_value);
  const int value = message_.bytes_per_value == 1 ? in[0] : in[0] | in[1] << 8;
  // A value that a signed 16-bit number cannot hold is no disparity either.
  const bool valid = value != message_.invalid && value <= std::numeric_limits<std::int16_t>::max();
  return valid ? static_cast<std::int16_t>(value) : DisparityMap::kNone;
}

void RowBlock::copy_row(int y, std::int16_t* out, Pixels pixels) const {
  for (int x = 0; x < message_.width; ++x) out[x] = at(x, y, pixels);
}

}  // namespace stereod
