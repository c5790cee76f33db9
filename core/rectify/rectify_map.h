// SPDX-License-Identifier: BSD-3-Clause
// The rectification table: undistortion, alignment and reading of luma in one pass over memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/base/aligned_buffer.h"
#include "core/base/image.h"
#include "core/base/validity_mask.h"
#include "core/base/worker_pool.h"
#include "core/geometry/calibration.h"
#include "core/rectify/bilinear.h"
#include "core/rectify/run_table.h"

namespace stereod {

/// The memory layout of a camera buffer; strides in bytes. The pixel stride of a luma plane is 1, of the Y of
/// YUYV 2, of a 24-bit color image 3.
struct SourceLayout {
  Size size;
  std::ptrdiff_t row_stride = 0;
  std::ptrdiff_t pixel_stride = 1;
  friend bool operator==(const SourceLayout&, const SourceLayout&) = default;
};

/// How a rectified pixel is computed whose source lies between pixels.
enum class Interpolation {
  kNearest,   ///< the nearest pixel, as cv::remap(INTER_NEAREST)
  kBilinear,  ///< the four around it, weighted in steps of 1/32 px, as cv::remap(INTER_LINEAR)
};
std::string_view name_of(Interpolation interpolation);
std::optional<Interpolation> parse_interpolation(std::string_view name);

/// Holds for every pixel of the rectified image where in the source buffer it comes from (thesis, section
/// 4.2.1), as runs of pixels that are copied together. The source coordinates are those of
/// cv::initUndistortRectifyMap, in double precision. A pixel becomes 0 if its source lies behind the camera
/// or outside the source image: by more than half a pixel (kNearest), or not between pixels (kBilinear). The
/// rectified image has the size of the source.
///
/// The functions that rectify rows read no byte outside the pixels of the source, write none outside the
/// given rows, and may be called by any number of threads at once.
class RectifyMap {
 public:
  /// Computes the table.
  /// @throws std::invalid_argument with a sentence if the layout is impossible or its size is not that of the
  /// calibration.
  RectifyMap(const CameraCalibration& calibration, const SourceLayout& layout,
             Interpolation interpolation = Interpolation::kNearest);

  /// Returns the table that changes nothing, for cameras without calibration.
  /// @throws std::invalid_argument with a sentence if the layout is impossible.
  static RectifyMap identity(const SourceLayout& layout);

  Size size() const { return layout_.size; }
  const SourceLayout& layout() const { return layout_; }
  Interpolation interpolation() const { return interpolation_; }

  /// Returns the source of pixel (@p x, @p y) of the rectified image, with kBilinear the upper left one of
  /// four: [bytes from the first pixel of the source], or −1. Searches the row, so it is too slow for every
  /// pixel of a frame.
  std::int32_t offset(int x, int y) const { return runs_.offset(x, y); }

  /// Returns which pixels of the rectified image have a source.
  ValidityMask mask() const {
    return {size(), [this](int x, int y) { return offset(x, y) >= 0; }};
  }

  /// Returns the bytes of the table.
  std::size_t bytes() const { return runs_.bytes() + across_.size() + down_.size(); }

  /// Writes row @p y of the rectified image to @p out: size().width bytes.
  void gray_row(const std::uint8_t* source, int y, std::uint8_t* out) const noexcept;

  /// Writes @p rows of the rectified image to the same rows of @p out, an image of size().
  void gray_rows(const std::uint8_t* source, RowRange rows, ImageView<std::uint8_t> out) const noexcept;

  /// Does the same with pixels of three bytes. The pixel stride of the layout must be ≥ 3, the interpolation
  /// kNearest.
  void color_rows(const std::uint8_t* source, RowRange rows, ImageView<Rgb> out) const noexcept;

 private:
  RectifyMap(const SourceLayout& layout, Interpolation interpolation);
  template <typename SourceOf>
  void fill(SourceOf source_of);
  std::int32_t nearest(const Point2& source) const;
  std::int32_t upper_left(const Point2& source, std::uint8_t& across, std::uint8_t& down) const;
  std::int32_t offset_to(std::ptrdiff_t x, std::ptrdiff_t y) const;
  // The distance to the right and to the lower neighbor [bytes]; 0 if the image has only one column or row.
  std::ptrdiff_t right() const { return layout_.size.width > 1 ? layout_.pixel_stride : 0; }
  std::ptrdiff_t below() const { return layout_.size.height > 1 ? layout_.row_stride : 0; }

  template <typename Copier>
  void nearest_row(const std::uint8_t* source, int y, std::uint8_t* out, const Copier& copier) const noexcept;
  template <typename Copier>
  void blended_row(const std::uint8_t* source, int y, std::uint8_t* out, const Copier& copier) const noexcept;
  template <typename Copier>
  void row(const std::uint8_t* source, int y, std::uint8_t* out, const Copier& copier) const noexcept;

  SourceLayout layout_;
  Interpolation interpolation_;
  RunTable runs_;
  Blend blend_;
  AlignedBuffer<std::uint8_t> across_, down_;  // as in BlendRow, for every pixel; only kBilinear
};

/// Rectify a whole image, cut into one band a worker of @p pool. @p out has the size map.size().
void rectify_gray(const RectifyMap& map, const std::uint8_t* source, ImageView<std::uint8_t> out,
                  WorkerPool& pool);
void rectify_color(const RectifyMap& map, const std::uint8_t* source, ImageView<Rgb> out, WorkerPool& pool);

}  // namespace stereod
