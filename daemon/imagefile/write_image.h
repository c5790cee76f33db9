// Pictures to PNG files.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/image.h"

namespace stereod {

/// Each writes a PNG of 8-bit grey, 8-bit RGB or 16-bit grey; the file appears whole or not at all. The sides
/// have 1 to 16384 pixels. They throw FileError with one sentence.
void write_png(const std::filesystem::path& path, ImageView<const std::uint8_t> grey);
void write_png(const std::filesystem::path& path, ImageView<const Rgb> color);
void write_png(const std::filesystem::path& path, ImageView<const std::uint16_t> grey);

}  // namespace stereod
