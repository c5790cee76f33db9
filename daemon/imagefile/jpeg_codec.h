// JPEG files, by libjpeg-turbo.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "daemon/imagefile/decoded_image.h"

namespace stereod {

bool looks_like_jpeg(std::span<const std::uint8_t> bytes);

enum class JpegChannels {
  kLuma,  ///< the brightness that the file itself stores
  kRgb,
};

/// Any 8-bit JPEG but CMYK; an orientation tag is ignored. Throws FileError, its sentence beginning with
/// `file`, also where libjpeg would deliver a image that is gray from the place of the damage on.
DecodedImage decode_jpeg(const std::string& file, std::span<const std::uint8_t> bytes, JpegChannels channels);

}  // namespace stereod
