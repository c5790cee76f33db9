// SPDX-License-Identifier: BSD-3-Clause
// Writes images to PNG files.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/base/image.h"

namespace stereod {

/// Write a PNG of 8-bit gray, 8-bit RGB or 16-bit gray. The file appears whole or not at all. Sides: 1…16384 px. Throw
/// FileError.
void write_png(const std::filesystem::path& path, ImageView<const std::uint8_t> gray);
void write_png(const std::filesystem::path& path, ImageView<const Rgb> color);
void write_png(const std::filesystem::path& path, ImageView<const std::uint16_t> gray);

}  // namespace stereod
