// SPDX-License-Identifier: BSD-3-Clause
// The rows of one message.
#pragma once

#include <cstddef>
#include <cstdint>

#include "stereo_frame.h"  // beside this header, in the source tree and where it is installed
#include "stereod/disparity_rows_t.hpp"

namespace stereod {

/// A view of the rows in one valid message (is_valid()). Valid during the call that hands it over.
///
/// Rows are rows of the published image: first_row ≤ y < first_row + row_count.
class RowBlock {
 public:
  explicit RowBlock(const disparity_rows_t& message) : message_(message) {}

  const disparity_rows_t& message() const { return message_; }
  int units_per_pixel() const { return message_.scale == 1.0F ? 1 : 16; }
  PixelGrid grid() const {
    return {message_.left, message_.top, message_.decimation_x, message_.decimation_y};
  }
  /// Returns a disparity in units of 1 / units_per_pixel() px, or DisparityMap::kNone.
  std::int16_t at(int x, int y, Pixels pixels = Pixels::kMeasured) const;
  /// Returns whether the pixel has a disparity that was filled, not measured.
  bool is_filled(int x, int y) const;
  bool has_filled() const { return message_.filled_size > 0; }
  /// Copies at() of a whole row, message().width values.
  void copy_row(int y, std::int16_t* out, Pixels pixels = Pixels::kMeasured) const;

  bool has_confidence() const { return message_.confidence_size > 0; }
  /// Returns the confidences of a row, message().width bytes. Requires has_confidence().
  const std::uint8_t* confidence_row(int y) const {
    return message_.confidence.data() + static_cast<std::ptrdiff_t>(y - message_.first_row) * message_.width;
  }

 private:
  const disparity_rows_t& message_;
};

}  // namespace stereod
