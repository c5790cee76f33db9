// Images to PNG files.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/base/image.h"

namespace stereod {

/// Each writes a PNG of 8-bit gray, 8-bit RGB or 16-bit gray; the file appears whole or not at all. The sides
/// have 1 to 16384 pixels. They throw FileError with one sentence.
void write_png(const std::filesystem::path& path, ImageView<const std::uint8_t> gray);
void write_png(const std::filesystem::path& path, ImageView<const Rgb> color);
void write_png(const std::filesystem::path& path, ImageView<const std::uint16_t> gray);

}  // namespace stereod
