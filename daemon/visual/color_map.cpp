#include "daemon/visual/color_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace stereod {

namespace {

// OKLab lightness 0.33 to 0.95 in equal steps; hue from 258° over 340° and 62° to 100°; chroma 0.16, or what
// sRGB has.
constexpr std::array<Rgb, 17> kSteps{{{0, 47, 119},
                                      {19, 51, 146},
                                      {46, 59, 158},
                                      {70, 67, 169},
                                      {97, 72, 177},
                                      {128, 76, 178},
                                      {158, 80, 173},
                                      {186, 85, 163},
                                      {211, 93, 148},
                                      {232, 104, 130},
                                      {248, 118, 111},
                                      {255, 139, 101},
                                      {255, 162, 105},
                                      {255, 183, 114},
                                      {255, 203, 128},
                                      {254, 222, 143},
                                      {255, 239, 171}}};

std::uint8_t between(std::uint8_t from, std::uint8_t to, double part) {
  return static_cast<std::uint8_t>(std::lround(from + (to - from) * part));
}

}  // namespace

Rgb nearness_color(double nearness) {
  // Written so that a NaN is far.
  const double place = nearness > 0 ? std::min(nearness, 1.0) * (kSteps.size() - 1) : 0;
  const auto step = std::min(static_cast<std::size_t>(place), kSteps.size() - 2);
  const double part = place - static_cast<double>(step);
  const Rgb from = kSteps[step];
  const Rgb to = kSteps[step + 1];
  return {between(from.r, to.r, part), between(from.g, to.g, part), between(from.b, to.b, part)};
}

}  // namespace stereod
