// SPDX-License-Identifier: BSD-3-Clause
// Draws numbers and units.
#pragma once

#include <string_view>

#include "core/base/image.h"

namespace stereod {

/// Letters have at most 5×7 dots, with one dot between them. The font has the digits, `.`, `-`, `m`, `p`, `x` and the
/// space; other characters are drawn as a box.
inline constexpr int kLetterHeight = 7;   ///< dots above the baseline
inline constexpr int kLetterDescent = 2;  ///< dots below the baseline, for the p

/// Returns the width of a text [px] at @p zoom [px per dot, ≥ 1].
int text_width(std::string_view text, int zoom);

/// Draws a text with its upper left corner at (@p x, @p y), clipped to the image.
void draw_text(ImageView<Rgb> image, int x, int y, std::string_view text, Rgb color, int zoom);

}  // namespace stereod
