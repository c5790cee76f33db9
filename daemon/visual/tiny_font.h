// Numbers and units in images.
#pragma once

#include <string_view>

#include "core/base/image.h"

namespace stereod {

/// The letters are at most 5×7 dots, with one dot between them. Known are the digits, `.`, `-`, `m`, `p`, `x`
/// and the space; anything else is drawn as a box.
inline constexpr int kLetterHeight = 7;   ///< dots above the baseline
inline constexpr int kLetterDescent = 2;  ///< dots below it, for the p

/// Width in pixels of a text at `zoom` (≥ 1) pixels per dot.
int text_width(std::string_view text, int zoom);

/// Draws with the text's upper left corner at (x, y); what lies outside the image is left out.
void draw_text(ImageView<Rgb> picture, int x, int y, std::string_view text, Rgb color, int zoom);

}  // namespace stereod
