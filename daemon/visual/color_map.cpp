// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/visual/color_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>

namespace stereod {

namespace {

constexpr Rgb kSteps[] = {
#include "daemon/visual/color_steps.inc"
};

std::uint8_t interpolated(std::uint8_t from, std::uint8_t to, double fraction) {
  return static_cast<std::uint8_t>(std::lround(from + (to - from) * fraction));
}

}  // namespace

Rgb nearness_color(double nearness) {
  // The comparison is false for NaN.
  const double position = nearness > 0 ? std::min(nearness, 1.0) * (std::size(kSteps) - 1) : 0;
  const auto step = std::min(static_cast<std::size_t>(position), std::size(kSteps) - 2);
  const double fraction = position - static_cast<double>(step);
  const Rgb from = kSteps[step];
  const Rgb to = kSteps[step + 1];
  return {interpolated(from.r, to.r, fraction), interpolated(from.g, to.g, fraction),
          interpolated(from.b, to.b, fraction)};
}

}  // namespace stereod
