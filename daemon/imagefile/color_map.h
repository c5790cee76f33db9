// The colours of near and far.
#pragma once

#include "core/image.h"

namespace stereod {

/// The colour of `nearness`, 0 (far) … 1 (near), clamped: deep blue, violet, coral, pale yellow. Lightness
/// rises evenly from one end to the other (it was laid out in the OKLab space), so equal steps look equal, a
/// grey print keeps the order, and the colour-blind read it too. No colour of it is grey or black; those are
/// free for "no match".
Rgb nearness_color(double nearness);

}  // namespace stereod
