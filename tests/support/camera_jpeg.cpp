// SPDX-License-Identifier: BSD-3-Clause
// Encoding with TurboJPEG.
#include "tests/support/camera_jpeg.h"

#include <turbojpeg.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace stereod {

std::vector<std::uint8_t> camera_jpeg(Size size, int value, int restart_rows) {
  std::vector<std::uint8_t> rgb;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto level = static_cast<std::uint8_t>(value >= 0 ? value : (x * 3 + y * 2) % 256);
      rgb.insert(rgb.end(), {level, level, level});
    }
  }
  // TurboJPEG reads this only from the environment.
  if (restart_rows > 0) setenv("TJ_RESTART", std::to_string(restart_rows).c_str(), 1);
  tjhandle encoder = tjInitCompress();
  unsigned char* out = nullptr;
  unsigned long length = 0;
  if (tjCompress2(encoder, rgb.data(), size.width, 0, size.height, TJPF_RGB, &out, &length, TJSAMP_422, 90,
                  0) != 0) {
    throw std::runtime_error(tjGetErrorStr2(encoder));
  }
  unsetenv("TJ_RESTART");
  std::vector<std::uint8_t> jpeg(out, out + length);
  tjFree(out);
  tjDestroy(encoder);
  return jpeg;
}

std::vector<std::uint8_t> without_huffman_tables(const std::vector<std::uint8_t>& jpeg) {
  constexpr int kHuffmanTable = 0xc4, kScan = 0xda;
  std::vector<std::uint8_t> stripped(jpeg.begin(), jpeg.begin() + 2);
  std::size_t at = 2;
  while (jpeg.at(at + 1) != kScan) {
    const std::size_t length = 2u + (std::size_t{jpeg.at(at + 2)} << 8) + jpeg.at(at + 3);
    const auto begin = jpeg.begin() + static_cast<std::ptrdiff_t>(at);
    if (jpeg.at(at + 1) != kHuffmanTable)
      stripped.insert(stripped.end(), begin, begin + static_cast<std::ptrdiff_t>(length));
    at += length;
  }
  stripped.insert(stripped.end(), jpeg.begin() + static_cast<std::ptrdiff_t>(at), jpeg.end());
  return stripped;
}

}  // namespace stereod
