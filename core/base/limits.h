// SPDX-License-Identifier: BSD-3-Clause
// Defines the maximum sizes of images.
#pragma once

namespace stereod {

/// Maximum width and height of an image that is captured, matched or sent [px]. Receivers refuse more, so that no
/// message can make them allocate gigabytes.
inline constexpr int kMaxImageSide = 4096;

/// Maximum width and height of an image in a file, and of a calibration [px].
inline constexpr int kMaxImageFileSide = 16384;

}  // namespace stereod
