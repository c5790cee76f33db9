// SPDX-License-Identifier: BSD-3-Clause
// A received frame: disparity, depth and points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "camera_geometry.h"  // beside this header, in the source tree and where it is installed
#include "stereod/frame_t.hpp"

namespace stereod {

/// Which disparities a function reads.
enum class Pixels {
  kMeasured,          ///< those that were matched
  kMeasuredOrFilled,  ///< also those that hole filling copied from neighbors
};

/// One value a pixel, row after row.
template <typename Value>
class PixelMap {
 public:
  PixelMap() = default;
  PixelMap(int width, int height, Value value)
      : width_(width),
        height_(height),
        values_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), value) {}

  int width() const { return width_; }
  int height() const { return height_; }
  /// Returns the value of pixel (@p x, @p y), which must lie in the image.
  Value at(int x, int y) const { return row(y)[x]; }
  Value* row(int y) { return values_.data() + static_cast<std::ptrdiff_t>(y) * width_; }
  const Value* row(int y) const { return values_.data() + static_cast<std::ptrdiff_t>(y) * width_; }

 private:
  int width_ = 0;
  int height_ = 0;
  std::vector<Value> values_;
};

/// Disparities in fixed point.
class DisparityMap : public PixelMap<std::int16_t> {
 public:
  static constexpr std::int16_t kNone = -1;  ///< no disparity, or the row did not arrive

  DisparityMap() = default;
  DisparityMap(int width, int height) : PixelMap(width, height, kNone) {}
};

/// Confidences: 0 (wrong) to 255 (right).
using ConfidenceMap = PixelMap<std::uint8_t>;

/// A frame, assembled from the rows that arrived.
struct StereoFrame {
  std::int64_t frame = 0;
  std::int64_t utime = 0;          ///< µs since the Unix epoch, start of the left exposure
  DisparityMap disparity;          ///< measured disparities, in units of 1 / units_per_pixel px
  DisparityMap filled;             ///< filled disparities, in the same units; 0×0 if the frame has none
  ConfidenceMap confidence;        ///< 0 where a row did not arrive; 0×0 if the daemon does not publish it
  PixelGrid grid;                  ///< where the pixels of `disparity` lie in the rectified image
  int units_per_pixel = 1;         ///< 1 or 16
  int min_disparity = 0;           ///< px
  int disparities = 0;             ///< number searched; 0 if no row arrived
  std::vector<bool> row_present;   ///< one for each row of the image
  int rows_expected = 0;           ///< the number in the summary; without a summary the height of the image
  int rows_received = 0;           ///< 0…rows_expected
  std::optional<frame_t> summary;  ///< fractions, timing, scan; empty if the frame summary did not arrive
  std::optional<CameraGeometry> camera;  ///< empty before the first camera_info_t, or without calibration

  /// Returns whether the summary and all rows arrived.
  bool complete() const { return summary.has_value() && rows_received >= rows_expected; }

  /// Returns the disparity of pixel (@p x, @p y) in px of the rectified image; NaN if it has none.
  float disparity_px(int x, int y, Pixels pixels = Pixels::kMeasured) const;
  /// Returns the distance along the optical axis [m]; NaN without a disparity or a camera, infinite at the horizon.
  float depth_m(int x, int y, Pixels pixels = Pixels::kMeasured) const;
  /// Returns the point of pixel (@p x, @p y); NaN in every coordinate where the depth is NaN or infinite.
  StereoPoint point(int x, int y, Pixels pixels = Pixels::kMeasured) const;

  /// Returns depth_m() of every pixel, row after row.
  std::vector<float> depths_m(Pixels pixels = Pixels::kMeasured) const;
  /// Returns the finite points of every @p step -th row and column [≥ 1] of `disparity`.
  std::vector<StereoPoint> points(int step = 1, Pixels pixels = Pixels::kMeasured) const;
};

}  // namespace stereod
