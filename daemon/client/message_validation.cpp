// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/client/message_validation.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace stereod {
namespace {

constexpr int kSubpixelUnits = 16;   // units in a pixel, unless they are whole pixels
constexpr int kMaxSide = 4096;       // px; no message can ask for gigabytes
constexpr int kMaxDisparity = 4096;  // px

bool is_image_size(int width, int height) {
  return width >= 1 && width <= kMaxSide && height >= 1 && height <= kMaxSide;
}

/// Returns whether @p count columns or rows, @p step apart from @p first on, lie in an image of up to kMaxSide.
bool is_axis(int first, int step, int count) {
  return first >= 0 && first < kMaxSide && step >= 1 && step <= kMaxSide &&
         first + (count - 1) * step < kMaxSide;
}

bool has_valid_geometry(const disparity_rows_t& m) {
  return is_image_size(m.width, m.height) && m.first_row >= 0 && m.row_count >= 1 &&
         m.row_count <= m.height && m.first_row <= m.height - m.row_count &&
         is_axis(m.left, m.decimation_x, m.width) && is_axis(m.top, m.decimation_y, m.height);
}

bool has_valid_values(const disparity_rows_t& m) {
  return m.min_disparity >= 0 && m.min_disparity <= kMaxDisparity && m.disparities >= 1 &&
         m.disparities <= kMaxDisparity && units_per_pixel_of(m.scale) != 0 &&
         (m.bytes_per_value == 1 || m.bytes_per_value == 2) && m.invalid >= 0 &&
         m.invalid <= (m.bytes_per_value == 1 ? 0xFF : 0xFFFF) && m.encoding == 0;
}

/// Returns whether data that may be absent is absent or has @p expected bytes. The code that lcm-gen makes does not clear
/// an array of length 0, so the array is read only if its length says so.
bool is_absent_or(int expected, int size, const std::vector<std::uint8_t>& bytes) {
  return size == 0 || (size == expected && bytes.size() == static_cast<std::size_t>(expected));
}

}  // namespace

int units_per_pixel_of(float scale) {
  if (scale == 1.0F) return 1;
  return scale == 1.0F / kSubpixelUnits ? kSubpixelUnits : 0;
}

bool is_valid(const disparity_rows_t& m) {
  if (m.frame < 0 || m.utime < 0 || !has_valid_geometry(m) || !has_valid_values(m)) return false;
  const int pixels = m.width * m.row_count;  // at most 2^24
  const int data_size = pixels * m.bytes_per_value;
  return m.size == data_size && m.data.size() == static_cast<std::size_t>(data_size) &&
         is_absent_or((m.width + 7) / 8 * m.row_count, m.filled_size, m.filled) &&
         is_absent_or(pixels, m.confidence_size, m.confidence);
}

bool is_valid(const frame_t& m) {
  const auto is_fraction = [](float value) { return value >= 0.0F && value <= 1.0F; };
  return m.frame >= 0 && m.utime >= 0 && is_image_size(m.width, m.height) && m.rows >= 1 &&
         m.rows <= m.height && m.messages >= 0 && is_fraction(m.measured_fraction) &&
         is_fraction(m.filled_fraction) &&
         (m.no_evidence_fraction == -1.0F || is_fraction(m.no_evidence_fraction));
}

}  // namespace stereod
