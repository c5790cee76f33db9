// The colors of near and far.
#pragma once

#include "core/base/image.h"

namespace stereod {

/// The color of `nearness`, 0 (far) … 1 (near), clamped: deep blue, violet, coral, pale yellow. Lightness
/// rises evenly from one end to the other (it was laid out in the OKLab space), so equal steps look equal, a
/// gray print keeps the order, and the color-blind read it too. No color of it is gray or black; those are
/// free for "no match".
Rgb nearness_color(double nearness);

}  // namespace stereod
