// SPDX-License-Identifier: BSD-3-Clause
// The scene of the simulated cameras: a wall of random blocks in steps of known disparity, scrolling with the
// frame number.
#pragma once

#include <cstdint>

#include "core/base/image.h"
#include "tests/vm/uvcsim/bytes.h"

namespace stereod::uvcsim {

enum class Eye { kLeft, kRight };

/// Number of frames after which the images repeat.
constexpr int kSceneFrames = 8;

/// Returns the disparity of a row [px]: steps of 60 rows with 8, 16, 24 and 32.
int scene_disparity(int row);

/// Returns the brightness of a pixel [30…219]. Frame numbers continue past the end of the loop.
std::uint8_t scene_brightness(Eye eye, int x, int y, int frame);

/// Returns the image at an exposure: brightness × gain_64 / 64 + offset, clamped to 0…255.
GrayImage render_scene(Eye eye, Size size, int frame, int gain_64 = 64, int offset = 0);

/// Returns the image as YUYV without color.
Bytes yuyv_bytes(const GrayImage& image);

}  // namespace stereod::uvcsim
