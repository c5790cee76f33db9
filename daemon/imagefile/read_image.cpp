// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/imagefile/read_image.h"

#include <new>
#include <string>
#include <vector>

#include "daemon/base/file.h"
#include "daemon/base/file_error.h"
#include "daemon/imagefile/decoded_image.h"
#include "daemon/imagefile/jpeg_codec.h"
#include "daemon/imagefile/png_codec.h"
#include "daemon/imagefile/pnm_codec.h"

namespace stereod {

namespace {

std::string printable_start(const std::vector<std::uint8_t>& bytes) {
  constexpr char kHex[] = "0123456789abcdef";
  std::string text;
  for (std::size_t i = 0; i < bytes.size() && i < 4; ++i) {
    if (i > 0) text += ' ';
    text += kHex[bytes[i] >> 4];
    text += kHex[bytes[i] & 15];
  }
  return text;
}

DecodedImage decode(const std::filesystem::path& path, JpegChannels jpeg_channels) {
  const std::string file = path.string();
  try {
    const std::vector<std::uint8_t> bytes = read_file_bytes(path);
    if (looks_like_png(bytes)) return decode_png(file, bytes);
    if (looks_like_jpeg(bytes)) return decode_jpeg(file, bytes, jpeg_channels);
    if (looks_like_pnm(bytes)) return decode_pnm(file, bytes);
    throw FileError(file + ": is not an image in a known format (begins with the bytes " +
                    printable_start(bytes) + "); allowed are PNG, JPEG, PGM and PPM");
  } catch (const std::bad_alloc&) {
    throw FileError(file + ": not enough memory for an image of this size");
  }
}

/// Scales a sample from 0…max_value to 0…255, rounded.
std::uint8_t to_8_bit(int value, int max_value) {
  return static_cast<std::uint8_t>((value * 255 + max_value / 2) / max_value);
}

Rgb color_at(const DecodedImage& image, std::size_t pixel) {
  if (image.channels == 1) {
    const std::uint8_t gray = to_8_bit(image.sample(pixel), image.max_value);
    return {gray, gray, gray};
  }
  return {to_8_bit(image.sample(3 * pixel), image.max_value),
          to_8_bit(image.sample(3 * pixel + 1), image.max_value),
          to_8_bit(image.sample(3 * pixel + 2), image.max_value)};
}

/// Returns an image whose pixel n, counted from the top left, is pixel_at(n).
template <typename Pixel, typename PixelAt>
Image<Pixel> fill_image(Size size, const PixelAt& pixel_at) {
  Image<Pixel> image(size);
  std::size_t pixel = 0;
  for (int y = 0; y < size.height; ++y) {
    for (Pixel *to = image.row(y), *end = to + size.width; to != end; ++to) *to = pixel_at(pixel++);
  }
  return image;
}

}  // namespace

void check_image_size(const std::string& file, long long width, long long height) {
  if (width >= 1 && width <= kMaxImageFileSide && height >= 1 && height <= kMaxImageFileSide) return;
  throw FileError(file + ": the image has " + std::to_string(width) + "×" + std::to_string(height) +
                  " pixels; 1 to " + std::to_string(kMaxImageFileSide) + " a side are allowed");
}

GrayImage read_gray(const std::filesystem::path& path) {
  const DecodedImage image = decode(path, JpegChannels::kLuma);
  if (image.channels == 1) {
    return fill_image<std::uint8_t>(
        image.size, [&](std::size_t pixel) { return to_8_bit(image.sample(pixel), image.max_value); });
  }
  return fill_image<std::uint8_t>(image.size,
                                  [&](std::size_t pixel) { return gray_of(color_at(image, pixel)); });
}

ColorImage read_color(const std::filesystem::path& path) {
  const DecodedImage image = decode(path, JpegChannels::kRgb);
  return fill_image<Rgb>(image.size, [&](std::size_t pixel) { return color_at(image, pixel); });
}

Image<std::uint16_t> read_gray16(const std::filesystem::path& path) {
  const DecodedImage image = decode(path, JpegChannels::kLuma);
  return fill_image<std::uint16_t>(image.size, [&](std::size_t pixel) {
    const auto channels = static_cast<std::size_t>(image.channels);
    const int value = image.sample(pixel * channels);
    for (std::size_t other = 1; other < channels; ++other) {
      if (image.sample(pixel * channels + other) != value) {
        throw FileError(path.string() + ": is a color image; a gray one is needed");
      }
    }
    return static_cast<std::uint16_t>(value);
  });
}

}  // namespace stereod
