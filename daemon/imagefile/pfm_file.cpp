// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/imagefile/pfm_file.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/file.h"
#include "daemon/base/file_error.h"
#include "daemon/imagefile/decoded_image.h"

namespace stereod {

namespace {

constexpr bool kLittleEndianHost = std::endian::native == std::endian::little;

std::uint32_t swap_bytes(std::uint32_t value) {
  return value >> 24 | (value >> 8 & 0xff00) | (value << 8 & 0xff0000) | value << 24;
}

/// Returns the next word of the header and skips it and one white-space character.
std::string_view next_word(std::span<const std::uint8_t> bytes, std::size_t& next) {
  const auto is_space = [&](std::size_t i) {
    return bytes[i] == ' ' || (bytes[i] >= '\t' && bytes[i] <= '\r');
  };
  while (next < bytes.size() && is_space(next)) ++next;
  const std::size_t first = next;
  while (next < bytes.size() && !is_space(next)) ++next;
  const std::size_t end = next;
  if (next < bytes.size()) ++next;
  return {reinterpret_cast<const char*>(bytes.data()) + first, end - first};
}

template <typename Number>
Number number_from(const std::string& file, std::string_view word, const char* what) {
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) {
    throw FileError(file + ": the " + std::string(what) + " in the PFM header is not a valid number");
  }
  return value;
}

}  // namespace

void write_pfm(const std::filesystem::path& path, ImageView<const float> image) {
  check_image_size(path.string(), image.width(), image.height());
  const std::string header =
      "Pf\n" + std::to_string(image.width()) + " " + std::to_string(image.height()) + "\n-1.0\n";
  std::vector<std::uint8_t> bytes(header.begin(), header.end());
  bytes.reserve(bytes.size() +
                4 * static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height()));
  for (int y = image.height() - 1; y >= 0; --y) {
    for (int x = 0; x < image.width(); ++x) {
      const auto bits = std::bit_cast<std::uint32_t>(image.at(x, y));
      for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
    }
  }
  write_file_bytes(path, bytes);
}

Image<float> read_pfm(const std::filesystem::path& path) {
  const std::string file = path.string();
  const std::vector<std::uint8_t> bytes = read_file_bytes(path);
  std::size_t next = 0;
  const std::string_view magic = next_word(bytes, next);
  if (magic == "PF") throw FileError(file + ": is a color PFM; a gray one (Pf) is needed");
  if (magic != "Pf") throw FileError(file + ": is not a PFM; the file must begin with Pf");
  const int width = number_from<int>(file, next_word(bytes, next), "width");
  const int height = number_from<int>(file, next_word(bytes, next), "height");
  check_image_size(file, width, height);
  const auto scale = number_from<double>(file, next_word(bytes, next), "scale");
  if (!std::isfinite(scale) || scale == 0) {
    throw FileError(file + ": the scale in the PFM header is not a valid number");
  }

  const std::size_t row_bytes = 4 * static_cast<std::size_t>(width);
  if (bytes.size() - next < row_bytes * static_cast<std::size_t>(height)) {
    throw FileError(file + ": the PFM file is truncated; it ends before its image does");
  }
  const bool swap = (scale < 0) != kLittleEndianHost;
  Image<float> image(width, height);
  for (int y = height - 1; y >= 0; --y, next += row_bytes) {
    std::memcpy(image.row(y), &bytes[next], row_bytes);
    if (!swap) continue;
    for (int x = 0; x < width; ++x) {
      image.at(x, y) = std::bit_cast<float>(swap_bytes(std::bit_cast<std::uint32_t>(image.at(x, y))));
    }
  }
  return image;
}

bool is_pfm(const std::filesystem::path& path) {
  const std::vector<std::uint8_t> bytes = read_file_bytes(path);
  return bytes.size() >= 2 && bytes[0] == 'P' && (bytes[1] == 'f' || bytes[1] == 'F');
}

}  // namespace stereod
