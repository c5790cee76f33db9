// SPDX-License-Identifier: BSD-3-Clause
// Rendering of the scene.
#include "tests/vm/uvcsim/scene.h"

#include <algorithm>
#include <array>

namespace stereod::uvcsim {

int scene_disparity(int row) { return 8 * (1 + row / 60 % 4); }

std::uint8_t scene_brightness(Eye eye, int x, int y, int frame) {
  constexpr int kBlock = 8;  // [px] like JPEG's blocks, so that little is lost and files are small
  const int shift = eye == Eye::kRight ? scene_disparity(y) : 0;
  const auto column = static_cast<std::uint32_t>((x + shift) / kBlock);
  const auto row = static_cast<std::uint32_t>(y / kBlock + frame % kSceneFrames);
  std::uint32_t hash = column * 0x9e3779b1U ^ row * 0x85ebca77U;
  hash = (hash ^ (hash >> 15)) * 0x2c1b3c6dU;
  hash = (hash ^ (hash >> 12)) * 0x297a2d39U;
  return static_cast<std::uint8_t>(30 + (hash >> 16) % 190);
}

GrayImage render_scene(Eye eye, Size size, int frame, int gain_64, int offset) {
  std::array<std::uint8_t, 256> exposed{};
  for (int value = 0; value < 256; ++value) {
    exposed[static_cast<std::size_t>(value)] =
        static_cast<std::uint8_t>(std::clamp(value * gain_64 / 64 + offset, 0, 255));
  }
  GrayImage image(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) image.row(y)[x] = exposed[scene_brightness(eye, x, y, frame)];
  }
  return image;
}

Bytes yuyv_bytes(const GrayImage& image) {
  constexpr std::uint8_t kNoColor = 128;
  Bytes bytes;
  bytes.reserve(static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height()) * 2);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      bytes.push_back(image.row(y)[x]);
      bytes.push_back(kNoColor);
    }
  }
  return bytes;
}

}  // namespace stereod::uvcsim
