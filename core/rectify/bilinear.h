// The arithmetic of bilinear interpolation, a row at a time.
#pragma once

#include <cstdint>

#include "core/base/cpu.h"

namespace stereod {

/// Parts of a pixel that interpolation knows, as in OpenCV.
inline constexpr int kBlendSteps = 32;

/// Rows of `count` pixels: the four neighbors of each point, and how far it lies from the upper left one:
/// `across` in 1/128 px and a multiple of 4, 0 to 128; `down` in 1/32 px, 0 to 32.
struct BlendRow {
  const std::uint8_t* top_left;
  const std::uint8_t* top_right;
  const std::uint8_t* bottom_left;
  const std::uint8_t* bottom_right;
  const std::uint8_t* across;
  const std::uint8_t* down;
};

/// Writes the weighted mean of the four, rounded to the nearest, halves up: what cv::remap(INTER_LINEAR) has
/// for coordinates of 1/32 px. Every instruction set gives the same.
using Blend = void (*)(const BlendRow& row, int count, std::uint8_t* out);

/// The function compiled for an instruction set that this CPU has (see resolve_isa()). Only AVX2 has one of
/// its own; what others have is what the compiler takes for the CPUs that the program as a whole is built
/// for.
Blend blend_for(Isa isa);

}  // namespace stereod
