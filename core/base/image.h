// SPDX-License-Identifier: BSD-3-Clause
// Images in memory: views that borrow pixels and images that own them.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "core/base/aligned_buffer.h"
#include "core/base/interval.h"

namespace stereod {

/// One pixel of a 24-bit color image, in memory order.
struct Rgb {
  std::uint8_t r, g, b;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};
static_assert(sizeof(Rgb) == 3);

/// Width and height [px].
struct Size {
  int width = 0;
  int height = 0;
  friend bool operator==(const Size&, const Size&) = default;
};

/// Borrows an image: `height` rows of `width` pixels, `stride` bytes from row to row (negative: bottom row
/// first). Pixel may be const. Cheap to copy; valid as long as the memory that it borrows.
template <typename Pixel>
class ImageView {
  using Byte = std::conditional_t<std::is_const_v<Pixel>, const std::byte, std::byte>;

 public:
  ImageView() = default;
  ImageView(Pixel* data, int width, int height, std::ptrdiff_t stride)
      : data_(reinterpret_cast<Byte*>(data)), width_(width), height_(height), stride_(stride) {}
  /// Converts a writable view into a read-only one.
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

/// Owns an image. Rows start on 64-byte boundaries, and at least 64 readable bytes follow every row, so that
/// vector code may read past its end. All pixels are zero after construction. Moves, does not copy.
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

/// Copies all pixels of @p from to @p to, which has the same size.
template <typename Pixel>
void copy_pixels(ImageView<const Pixel> from, ImageView<Pixel> to) {
  assert(from.size() == to.size());
  for (int y = 0; y < from.height(); ++y) std::copy_n(from.row(y), from.width(), to.row(y));
}

}  // namespace stereod
