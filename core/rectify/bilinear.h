// SPDX-License-Identifier: BSD-3-Clause
// The arithmetic of bilinear interpolation, a row at a time.
#pragma once

#include <cstdint>

#include "core/base/cpu.h"

namespace stereod {

/// Steps a pixel of the coordinates, as in OpenCV.
inline constexpr int kBlendSteps = 32;

/// The four neighbors of each point of a row, and its distance from the upper left one: `across` [1/128 px,
/// 0…128, a multiple of 4] and `down` [1/32 px, 0…32].
struct BlendRow {
  const std::uint8_t* top_left;
  const std::uint8_t* top_right;
  const std::uint8_t* bottom_left;
  const std::uint8_t* bottom_right;
  const std::uint8_t* across;
  const std::uint8_t* down;
};

/// Writes the weighted mean of the four neighbors of @p count points, rounded to the nearest integer, halves
/// up: what cv::remap(INTER_LINEAR) computes for coordinates of 1/32 px. All instruction sets give the same.
using Blend = void (*)(const BlendRow& row, int count, std::uint8_t* out);

/// Returns the function for @p isa, a result of resolve_isa(). AVX2 has one of its own; the other sets use
/// that of the CPUs that the whole program is compiled for.
Blend blend_for(Isa isa);

}  // namespace stereod
