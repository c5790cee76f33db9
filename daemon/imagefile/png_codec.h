// SPDX-License-Identifier: BSD-3-Clause
// Decodes and encodes PNG in memory with libpng.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "daemon/imagefile/decoded_image.h"

namespace stereod {

bool looks_like_png(std::span<const std::uint8_t> bytes);

/// Decodes any PNG: gray, color or palette, 1 to 16 bits, interlaced or not. Gray keeps its depth (see max_value), a palette
/// becomes color, transparency and gamma are ignored. Throws FileError, beginning with @p file.
DecodedImage decode_png(const std::string& file, std::span<const std::uint8_t> bytes);

/// Returns an image as a PNG file. Throws FileError unless both sides are 1…kMaxImageFileSide px.
std::vector<std::uint8_t> encode_png(const std::string& file, ImageView<const std::uint8_t> gray);
std::vector<std::uint8_t> encode_png(const std::string& file, ImageView<const Rgb> color);
std::vector<std::uint8_t> encode_png(const std::string& file, ImageView<const std::uint16_t> gray);

}  // namespace stereod
