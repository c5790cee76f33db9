// SPDX-License-Identifier: BSD-3-Clause
// Decodes PGM and PPM files (netpbm's formats P2, P3, P5 and P6).
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "daemon/imagefile/decoded_image.h"

namespace stereod {

bool looks_like_pnm(std::span<const std::uint8_t> bytes);

/// Decodes the first image of the file: plain or raw, gray or color, with comments, maxval 1…65535. White space must follow
/// every number of a plain image, also the last, as the format demands: otherwise a truncated number would be read as a
/// smaller number. Throws FileError, beginning with @p file.
DecodedImage decode_pnm(const std::string& file, std::span<const std::uint8_t> bytes);

}  // namespace stereod
