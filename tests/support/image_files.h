// SPDX-License-Identifier: BSD-3-Clause
// Creates image files without the code under test.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/base/image.h"

namespace stereod {

using Bytes = std::vector<std::uint8_t>;

enum class PngKind { kGray, kGrayAlpha, kRgb, kRgbAlpha, kPalette };

/// Returns a PNG with these channel samples (for kPalette: indices) of @p depth bits. Entry i of the palette is
/// palette_color(i).
Bytes make_png(PngKind kind, int depth, bool interlaced, Size size, const std::vector<int>& samples);
Rgb palette_color(int index);

/// Return JPEG files with 1, 3 (RGB) or 4 (CMYK) samples per pixel.
Bytes make_gray_jpeg(Size size, const std::vector<int>& samples, bool progressive);
Bytes make_rgb_jpeg(Size size, const std::vector<int>& samples);
Bytes make_cmyk_jpeg(Size size);

/// Returns @p header followed by the samples, 8-bit, or 16-bit big-endian if @p wide.
Bytes make_raw_pnm(const std::string& header, const std::vector<int>& samples, bool wide);

/// Returns @p count pseudorandom samples, 0…@p max.
std::vector<int> some_samples(int count, int max);

Bytes bytes_of(const std::string& text);
Bytes bytes_in(const std::filesystem::path& path);
void write_bytes(const std::filesystem::path& path, const Bytes& bytes);

/// Returns the message of the FileError that @p action throws; empty if it throws none.
std::string file_error_of(const std::function<void()>& action);

}  // namespace stereod
