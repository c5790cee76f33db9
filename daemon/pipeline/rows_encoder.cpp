#include "daemon/pipeline/rows_encoder.h"

#include <algorithm>
#include <cstddef>

namespace stereod {
namespace {

int bit_bytes(int width) { return (width + 7) / 8; }

/// What is sent of a pixel; kInvalidDisparity becomes 255 or 65535.
std::int16_t wire_value(std::int16_t value) { return is_filled(value) ? filled_disparity(value) : value; }

void encode_values(const std::int16_t* in, int width, int bytes_per_value, std::uint8_t* out) {
  if (bytes_per_value == 1) {
    for (int x = 0; x < width; ++x) out[x] = static_cast<std::uint8_t>(wire_value(in[x]));
    return;
  }
  for (std::ptrdiff_t x = 0; x < width; ++x) {
    const auto value = static_cast<std::uint16_t>(wire_value(in[x]));
    out[2 * x] = static_cast<std::uint8_t>(value);
    out[2 * x + 1] = static_cast<std::uint8_t>(value >> 8);
  }
}

void encode_filled(const std::int16_t* in, int width, std::uint8_t* out) {
  std::fill_n(out, bit_bytes(width), std::uint8_t{0});
  for (int x = 0; x < width; ++x) {
    if (is_filled(in[x])) out[x / 8] = static_cast<std::uint8_t>(out[x / 8] | 1U << (x % 8));
  }
}

}  // namespace

void reserve_rows(disparity_rows_t& message, int width, int rows, int bytes_per_value) {
  message.data.reserve(static_cast<std::size_t>(rows * width * bytes_per_value));
  message.filled.reserve(static_cast<std::size_t>(rows * bit_bytes(width)));
}

std::int64_t encode_rows(DisparityView disparity, RowRange rows, disparity_rows_t& message) noexcept {
  const int width = message.width;
  message.row_count = rows.count();
  message.size = rows.count() * width * message.bytes_per_value;
  message.data.resize(static_cast<std::size_t>(message.size));
  std::uint8_t* out = message.data.data();
  std::int64_t measured = 0, filled = 0;
  for (int y = rows.first; y < rows.end; ++y) {
    const std::int16_t* in = disparity.row(y);
    int row_measured = 0, row_filled = 0;
    for (int x = 0; x < width; ++x) {
      row_measured += in[x] >= 0 ? 1 : 0;
      row_filled += is_filled(in[x]) ? 1 : 0;
    }
    encode_values(in, width, message.bytes_per_value, out);
    out += std::ptrdiff_t{width} * message.bytes_per_value;
    measured += row_measured;
    filled += row_filled;
  }
  message.filled_size = filled > 0 ? rows.count() * bit_bytes(width) : 0;
  message.filled.resize(static_cast<std::size_t>(message.filled_size));
  if (filled == 0) return measured;
  std::uint8_t* bits = message.filled.data();
  for (int y = rows.first; y < rows.end; ++y, bits += bit_bytes(width)) {
    encode_filled(disparity.row(y), width, bits);
  }
  return measured;
}

}  // namespace stereod
