// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/publish/rows_encoder.h"

#include <algorithm>
#include <cstddef>

namespace stereod {
namespace {

int bytes_of_bits(int width) { return (width + 7) / 8; }

/// Returns the value to send, its lowest byte or two; kInvalidDisparity becomes 255 or 65535.
std::int16_t wire_value(std::int16_t value) { return is_filled(value) ? filled_disparity(value) : value; }

/// Every `decimation`-th pixel of a row.
struct DecimatedRow {
  const std::int16_t* row;
  int decimation;
  std::int16_t operator[](std::ptrdiff_t u) const { return row[u * decimation]; }
};

// Row is a pointer, for which the compiler emits vector instructions, or a DecimatedRow.
template <typename Row>
void encode_row(Row in, int width, int bytes_per_value, std::uint8_t* out, PixelCounts& counts) {
  int measured = 0, filled = 0;
  for (std::ptrdiff_t u = 0; u < width; ++u) {
    measured += in[u] >= 0 ? 1 : 0;
    filled += is_filled(in[u]) ? 1 : 0;
  }
  counts.measured += measured;
  counts.filled += filled;
  if (bytes_per_value == 1) {
    for (std::ptrdiff_t u = 0; u < width; ++u) out[u] = static_cast<std::uint8_t>(wire_value(in[u]));
    return;
  }
  for (std::ptrdiff_t u = 0; u < width; ++u) {
    const auto value = static_cast<std::uint16_t>(wire_value(in[u]));
    out[2 * u] = static_cast<std::uint8_t>(value);
    out[2 * u + 1] = static_cast<std::uint8_t>(value >> 8);
  }
}

void encode_bits(DecimatedRow in, int width, std::uint8_t* out) {
  std::fill_n(out, bytes_of_bits(width), std::uint8_t{0});
  for (int u = 0; u < width; ++u) {
    if (is_filled(in[u])) out[u / 8] = static_cast<std::uint8_t>(out[u / 8] | 1U << (u % 8));
  }
}

}  // namespace

void reserve_rows(disparity_rows_t& message, int width, int rows, int bytes_per_value) {
  message.data.reserve(static_cast<std::size_t>(rows * width * bytes_per_value));
  message.filled.reserve(static_cast<std::size_t>(rows * bytes_of_bits(width)));
}

PixelCounts encode_rows(DisparityView disparity, RowRange rows, disparity_rows_t& message) noexcept {
  const int width = message.width;
  const auto row = [&](int v) {
    return disparity.row(message.top + v * message.decimation_y) + message.left;
  };
  message.first_row = rows.first;
  message.row_count = rows.count();
  message.size = rows.count() * width * message.bytes_per_value;
  message.data.resize(static_cast<std::size_t>(message.size));
  PixelCounts counts;
  std::uint8_t* out = message.data.data();
  for (int v = rows.first; v < rows.end; ++v) {
    if (message.decimation_x == 1) {
      encode_row(row(v), width, message.bytes_per_value, out, counts);
    } else {
      encode_row(DecimatedRow{row(v), message.decimation_x}, width, message.bytes_per_value, out, counts);
    }
    out += std::ptrdiff_t{width} * message.bytes_per_value;
  }
  message.filled_size = counts.filled > 0 ? rows.count() * bytes_of_bits(width) : 0;
  message.filled.resize(static_cast<std::size_t>(message.filled_size));
  if (counts.filled == 0) return counts;
  std::uint8_t* bits = message.filled.data();
  for (int v = rows.first; v < rows.end; ++v, bits += bytes_of_bits(width)) {
    encode_bits({row(v), message.decimation_x}, width, bits);
  }
  return counts;
}

}  // namespace stereod
