// Image files of every kind, made without the code under test.
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

/// A PNG whose channel samples are `samples` in order (for kPalette: indices), each `depth` bits. The
/// palette's entry i is palette_color(i).
Bytes make_png(PngKind kind, int depth, bool interlaced, Size size, const std::vector<int>& samples);
Rgb palette_color(int index);

/// JPEGs: of gray values, of 3 samples a pixel, or of 4 (CMYK).
Bytes make_gray_jpeg(Size size, const std::vector<int>& samples, bool progressive);
Bytes make_rgb_jpeg(Size size, const std::vector<int>& samples);
Bytes make_cmyk_jpeg(Size size);

/// `header` and the samples as bytes, or as big-endian pairs of bytes if `wide`.
Bytes make_raw_pnm(const std::string& header, const std::vector<int>& samples, bool wide);

/// `count` samples 0 … max that change quickly.
std::vector<int> some_samples(int count, int max);

Bytes bytes_of(const std::string& text);
Bytes bytes_in(const std::filesystem::path& path);
void write_bytes(const std::filesystem::path& path, const Bytes& bytes);

/// The sentence of the FileError that `action` throws; empty if it throws none.
std::string file_error_of(const std::function<void()>& action);

}  // namespace stereod
