// Images in memory: views that borrow and images that own.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "core/base/aligned_buffer.h"

namespace stereod {

/// One pixel of a 24-bit color image, as it lies in memory.
struct Rgb {
  std::uint8_t r, g, b;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};
static_assert(sizeof(Rgb) == 3);

/// Width and height in pixels.
struct Size {
  int width = 0;
  int height = 0;
  friend bool operator==(const Size&, const Size&) = default;
};

/// Rows [first, end) of an image.
struct RowRange {
  int first = 0;
  int end = 0;
  int count() const { return end - first; }
  friend bool operator==(const RowRange&, const RowRange&) = default;
};

/// The rows of `image_height` that band `band` of `bands` equal ones has; the first bands take the remainder.
inline RowRange band_rows(int image_height, int band, int bands) {
  const int base = image_height / bands;
  const int rest = image_height % bands;
  const int first = band * base + std::min(band, rest);
  return {first, first + base + (band < rest ? 1 : 0)};
}

/// A image that belongs to someone else: `height` rows of `width` pixels, `stride` bytes from row to row.
/// Pixel may be const. Cheap to copy; valid as long as the memory behind it.
template <typename Pixel>
class ImageView {
  using Byte = std::conditional_t<std::is_const_v<Pixel>, const std::byte, std::byte>;

 public:
  ImageView() = default;
  ImageView(Pixel* data, int width, int height, std::ptrdiff_t stride)
      : data_(reinterpret_cast<Byte*>(data)), width_(width), height_(height), stride_(stride) {}
  /// A view to change is also a view to read.
  template <typename Other>
  requires std::is_same_v<const Other, Pixel> ImageView(const ImageView<Other>& other)
      : ImageView(other.row(0), other.width(), other.height(), other.stride()) {}

  int width() const { return width_; }
  int height() const { return height_; }
  Size size() const { return {width_, height_}; }
  std::ptrdiff_t stride() const { return stride_; }
  bool empty() const { return width_ <= 0 || height_ <= 0; }
  Pixel* row(int y) const { return reinterpret_cast<Pixel*>(data_ + y * stride_); }
  Pixel& at(int x, int y) const {
    assert(x >= 0 && x < width_ && y >= 0 && y < height_);
    return row(y)[x];
  }

 private:
  Byte* data_ = nullptr;
  int width_ = 0;
  int height_ = 0;
  std::ptrdiff_t stride_ = 0;
};

/// A image that owns its memory: rows start on 64-byte boundaries and at least 64 readable bytes follow
/// every row, so that vector code may read past its end. The pixels start as zero.
template <typename Pixel>
class Image {
  static_assert(std::is_trivially_copyable_v<Pixel>);

 public:
  Image() = default;
  Image(int width, int height)
      : width_(width),
        height_(height),
        stride_(padded(width)),
        memory_(stride_ * static_cast<std::size_t>(height)) {}
  explicit Image(Size size) : Image(size.width, size.height) {}

  int width() const { return width_; }
  int height() const { return height_; }
  Size size() const { return {width_, height_}; }
  bool empty() const { return width_ <= 0 || height_ <= 0; }
  Pixel* row(int y) { return view().row(y); }
  const Pixel* row(int y) const { return view().row(y); }
  Pixel& at(int x, int y) { return view().at(x, y); }
  const Pixel& at(int x, int y) const { return view().at(x, y); }
  ImageView<Pixel> view() {
    return {reinterpret_cast<Pixel*>(memory_.data()), width_, height_, static_cast<std::ptrdiff_t>(stride_)};
  }
  ImageView<const Pixel> view() const {
    return {reinterpret_cast<const Pixel*>(memory_.data()), width_, height_,
            static_cast<std::ptrdiff_t>(stride_)};
  }

 private:
  static std::size_t padded(int width) {
    const std::size_t bytes = static_cast<std::size_t>(width) * sizeof(Pixel);
    return (bytes + 63) / 64 * 64 + 64;
  }

  int width_ = 0;
  int height_ = 0;
  std::size_t stride_ = 0;
  AlignedBuffer<std::byte> memory_;
};

using GrayView = ImageView<const std::uint8_t>;
using GrayImage = Image<std::uint8_t>;
using ColorImage = Image<Rgb>;

/// Copies pixel by pixel; both have the same size.
template <typename Pixel>
void copy_pixels(ImageView<const Pixel> from, ImageView<Pixel> to) {
  assert(from.size() == to.size());
  for (int y = 0; y < from.height(); ++y) std::copy_n(from.row(y), from.width(), to.row(y));
}

}  // namespace stereod
