// The rectification table: undistortion, alignment and reading of luma in one pass over memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/aligned_buffer.h"
#include "core/calibration.h"
#include "core/image.h"
#include "core/validity_mask.h"
#include "core/worker_pool.h"

namespace stereod {

/// How the pixels of a camera's buffer lie in memory; strides in bytes. A luma plane has pixel stride 1, the
/// Y of YUYV 2, a 24-bit colour image 3.
struct SourceLayout {
  Size size;
  std::ptrdiff_t row_stride = 0;
  std::ptrdiff_t pixel_stride = 1;
  friend bool operator==(const SourceLayout&, const SourceLayout&) = default;
};

/// For every pixel of the rectified image, the memory offset of its nearest neighbour in the source buffer
/// (thesis, section 4.2.1). The source coordinates are those of cv::initUndistortRectifyMap, in double
/// precision, and rounded as cv::remap with INTER_NEAREST does. What lies outside the source image, or behind
/// the camera, becomes 0. The rectified image has the size of the source.
///
/// The methods that move rows read no byte outside the source's pixels, write none outside the given rows,
/// and may be called by any number of threads at once.
class RectifyMap {
 public:
  /// Throws std::invalid_argument with a sentence if the layout is impossible or not of the calibration's
  /// size.
  RectifyMap(const CameraCalibration& calibration, const SourceLayout& layout);

  /// The table that changes nothing, for cameras without calibration. Throws as above.
  static RectifyMap identity(const SourceLayout& layout);

  Size size() const { return layout_.size; }
  const SourceLayout& layout() const { return layout_; }

  /// Where pixel (x, y) of the rectified image comes from: bytes from the source's first pixel, or -1.
  std::int32_t offset(int x, int y) const { return row_of_table(y)[x]; }

  /// Which pixels of the rectified image have a source.
  ValidityMask mask() const {
    return {size(), [this](int x, int y) { return offset(x, y) >= 0; }};
  }

  /// Rectifies row `y` into `out`: size().width bytes.
  void grey_row(const std::uint8_t* source, int y, std::uint8_t* out) const noexcept;

  /// Rectifies `rows` into the same rows of `out`, an image of size().
  void grey_rows(const std::uint8_t* source, RowRange rows, ImageView<std::uint8_t> out) const noexcept;

  /// The same for pixels of three bytes; the layout's pixel stride is at least 3. Each pixel is moved as one
  /// 32-bit word whose dummy byte the next pixel overwrites (thesis, listing A.6).
  void color_rows(const std::uint8_t* source, RowRange rows, ImageView<Rgb> out) const noexcept;

 private:
  // What is known of a row beforehand, so that its inner loop need not ask.
  struct Row {
    std::int32_t inside_first = 0;  // [inside_first, inside_end): the longest run of pixels
    std::int32_t inside_end = 0;    // that all lie in the source
    bool has_last_pixel = false;    // takes the source's last pixel, after which no fourth byte may be read
  };

  explicit RectifyMap(const SourceLayout& layout);
  const std::int32_t* row_of_table(int y) const {
    return offsets_.data() + static_cast<std::ptrdiff_t>(y) * layout_.size.width;
  }
  std::int32_t offset_of(double source_x, double source_y) const;
  void describe_rows();

  SourceLayout layout_;
  AlignedBuffer<std::int32_t> offsets_;
  std::vector<Row> rows_;
};

/// Rectifies a whole image, its rows split evenly over the workers. `out` is of map.size().
void rectify_grey(const RectifyMap& map, const std::uint8_t* source, ImageView<std::uint8_t> out,
                  WorkerPool& pool);
void rectify_color(const RectifyMap& map, const std::uint8_t* source, ImageView<Rgb> out, WorkerPool& pool);

}  // namespace stereod
