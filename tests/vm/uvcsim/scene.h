// What the simulated cameras see: a wall of random blocks in steps of known disparity, scrolling with the
// frame number.
#pragma once

#include <cstdint>

#include "core/base/image.h"
#include "tests/vm/uvcsim/bytes.h"

namespace stereod::uvcsim {

enum class Eye { kLeft, kRight };

/// The images repeat after so many frames.
constexpr int kSceneFrames = 8;

/// Disparity of a row, px: steps of 60 rows with 8, 16, 24 and 32.
int scene_disparity(int row);

/// One pixel, 30…219; the same arguments give the same value for ever. `frame` is counted on past the end of
/// the loop.
std::uint8_t scene_brightness(Eye eye, int x, int y, int frame);

/// The whole image as a camera with this exposure shows it: brightness × gain_64 / 64 + offset, within
/// 0…255.
GrayImage render_scene(Eye eye, Size size, int frame, int gain_64 = 64, int offset = 0);

/// The image as YUYV without color.
Bytes yuyv_bytes(const GrayImage& picture);

}  // namespace stereod::uvcsim
