// SPDX-License-Identifier: BSD-3-Clause
// Decodes JPEG files with libjpeg-turbo.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "daemon/imagefile/decoded_image.h"

namespace stereod {

bool looks_like_jpeg(std::span<const std::uint8_t> bytes);

enum class JpegChannels {
  kLuma,  ///< the brightness as the file stores it
  kRgb,
};

/// Decodes an 8-bit JPEG, gray or RGB. Ignores orientation tags. Throws FileError, beginning with @p file, also for damage that
/// libjpeg only warns of and fills with gray.
DecodedImage decode_jpeg(const std::string& file, std::span<const std::uint8_t> bytes, JpegChannels channels);

}  // namespace stereod
