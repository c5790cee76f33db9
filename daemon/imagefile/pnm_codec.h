// PGM and PPM files (netpbm's formats P2, P3, P5 and P6).
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "daemon/imagefile/decoded_image.h"

namespace stereod {

bool looks_like_pnm(std::span<const std::uint8_t> bytes);

/// The first image of the file: plain or raw, gray or color, comments, maxval 1…65535. As the format
/// demands, white space follows every number of a plain image, the last one too: without it a truncated
/// number would pass for a smaller one. Throws FileError, its sentence beginning with `file`.
DecodedImage decode_pnm(const std::string& file, std::span<const std::uint8_t> bytes);

}  // namespace stereod
