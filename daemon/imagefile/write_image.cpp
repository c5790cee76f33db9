// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/imagefile/write_image.h"

#include "daemon/base/file.h"
#include "daemon/imagefile/png_codec.h"

namespace stereod {

void write_png(const std::filesystem::path& path, ImageView<const std::uint8_t> gray) {
  write_file_bytes(path, encode_png(path.string(), gray));
}

void write_png(const std::filesystem::path& path, ImageView<const Rgb> color) {
  write_file_bytes(path, encode_png(path.string(), color));
}

void write_png(const std::filesystem::path& path, ImageView<const std::uint16_t> gray) {
  write_file_bytes(path, encode_png(path.string(), gray));
}

}  // namespace stereod
