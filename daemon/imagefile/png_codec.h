// PNG in memory: what libpng does, without its long jumps.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "daemon/imagefile/decoded_image.h"

namespace stereod {

bool looks_like_png(std::span<const std::uint8_t> bytes);

/// Any PNG: gray, color or palette, 1 to 16 bits, interlaced or not. Gray keeps its depth (max_value says
/// which), a palette becomes color, transparency and gamma are ignored. Throws FileError, its sentence
/// beginning with `file`.
DecodedImage decode_png(const std::string& file, std::span<const std::uint8_t> bytes);

/// The PNG file of a image. Throws FileError if it is empty or has a side longer than kMaxImageFileSide.
std::vector<std::uint8_t> encode_png(const std::string& file, ImageView<const std::uint8_t> gray);
std::vector<std::uint8_t> encode_png(const std::string& file, ImageView<const Rgb> color);
std::vector<std::uint8_t> encode_png(const std::string& file, ImageView<const std::uint16_t> gray);

}  // namespace stereod
