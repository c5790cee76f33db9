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

/// How the pixels of a camera's buffer lie in memory; strides in bytes. A luma plane has pixel stride 1, the
/// Y of YUYV 2, a 24-bit color image 3.
struct SourceLayout {
  Size size;
  std::ptrdiff_t row_stride = 0;
  std::ptrdiff_t pixel_stride = 1;
  friend bool operator==(const SourceLayout&, const SourceLayout&) = default;
};

/// What a rectified pixel is made of, where its source lies between pixels.
enum class Interpolation {
  kNearest,   ///< the nearest pixel, as cv::remap(INTER_NEAREST) has it
  kBilinear,  ///< the four around it, weighted in steps of 1/32 px, as cv::remap(INTER_LINEAR) has it
};
std::string_view name_of(Interpolation interpolation);
std::optional<Interpolation> parse_interpolation(std::string_view name);

/// For every pixel of the rectified image, where in the source buffer it comes from (thesis, section 4.2.1),
/// as runs of pixels that move together. The source coordinates are those of cv::initUndistortRectifyMap, in
/// double precision. What lies outside the source image, or behind the camera, becomes 0: nearest, what is
/// more than half a pixel outside; bilinear, what is not between pixels. The rectified image has the size of
/// the source.
///
/// The methods that move rows read no byte outside the source's pixels, write none outside the given rows,
/// and may be called by any number of threads at once.
class RectifyMap {
 public:
  /// Throws std::invalid_argument with a sentence if the layout is impossible or not of the calibration's
  /// size.
  RectifyMap(const CameraCalibration& calibration, const SourceLayout& layout,
             Interpolation interpolation = Interpolation::kNearest);

  /// The table that changes nothing, for cameras without calibration. Throws as above.
  static RectifyMap identity(const SourceLayout& layout);

  Size size() const { return layout_.size; }
  const SourceLayout& layout() const { return layout_; }
  Interpolation interpolation() const { return interpolation_; }

  /// Where pixel (x, y) of the rectified image comes from: bytes from the source's first pixel, or -1; the
  /// upper left one of four. Looks through the row: nothing for every pixel of a frame.
  std::int32_t offset(int x, int y) const { return runs_.offset(x, y); }

  /// Which pixels of the rectified image have a source.
  ValidityMask mask() const {
    return {size(), [this](int x, int y) { return offset(x, y) >= 0; }};
  }

  /// How much memory the table takes.
  std::size_t bytes() const { return runs_.bytes() + across_.size() + down_.size(); }

  /// Rectifies row `y` into `out`: size().width bytes.
  void gray_row(const std::uint8_t* source, int y, std::uint8_t* out) const noexcept;

  /// Rectifies `rows` into the same rows of `out`, an image of size().
  void gray_rows(const std::uint8_t* source, RowRange rows, ImageView<std::uint8_t> out) const noexcept;

  /// The same for pixels of three bytes; the layout's pixel stride is at least 3, the interpolation kNearest.
  void color_rows(const std::uint8_t* source, RowRange rows, ImageView<Rgb> out) const noexcept;

 private:
  RectifyMap(const SourceLayout& layout, Interpolation interpolation);
  template <typename SourceOf>
  void fill(SourceOf source_of);
  std::int32_t nearest(const Point2& at) const;
  std::int32_t upper_left(const Point2& at, std::uint8_t& across, std::uint8_t& down) const;
  std::int32_t offset_to(std::ptrdiff_t x, std::ptrdiff_t y) const;
  // To the right and lower neighbor, in bytes; 0 where the image has only one column or row.
  std::ptrdiff_t right() const { return layout_.size.width > 1 ? layout_.pixel_stride : 0; }
  std::ptrdiff_t below() const { return layout_.size.height > 1 ? layout_.row_stride : 0; }

  template <typename Mover>
  void nearest_row(const std::uint8_t* source, int y, std::uint8_t* out, const Mover& mover) const noexcept;
  template <typename Mover>
  void blended_row(const std::uint8_t* source, int y, std::uint8_t* out, const Mover& mover) const noexcept;
  template <typename Mover>
  void row(const std::uint8_t* source, int y, std::uint8_t* out, const Mover& mover) const noexcept;

  SourceLayout layout_;
  Interpolation interpolation_;
  RunTable runs_;
  Blend blend_;
  AlignedBuffer<std::uint8_t> across_, down_;  // BlendRow's, for every pixel; only kBilinear
};

/// Rectifies a whole image, its rows split evenly over the workers. `out` is of map.size().
void rectify_gray(const RectifyMap& map, const std::uint8_t* source, ImageView<std::uint8_t> out,
                  WorkerPool& pool);
void rectify_color(const RectifyMap& map, const std::uint8_t* source, ImageView<Rgb> out, WorkerPool& pool);

}  // namespace stereod
