// SPDX-License-Identifier: BSD-3-Clause
// The colors of near and far, for files, the page of stereo-view and stereod-spy.
#pragma once

#include "core/base/image.h"

namespace stereod {

/// Returns the color of @p nearness [0 (far)…1 (near), clamped; NaN is far]: deep blue, violet, coral, pale yellow.
///
/// Lightness rises evenly (in OKLab), so that equal steps look equal, a gray print keeps the order, and color-blind people
/// can read the image. No color is gray or black; those remain for pixels without a disparity.
Rgb nearness_color(double nearness);

/// The color of a pixel without a disparity.
inline constexpr Rgb kUnmatchedColor{34, 34, 36};

}  // namespace stereod
