// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/view/palette_module.h"

#include "daemon/visual/color_map.h"

namespace stereod::tools {
namespace {

constexpr int kColors = 256;

std::string array_of(Rgb color) {
  return "[" + std::to_string(color.r) + "," + std::to_string(color.g) + "," + std::to_string(color.b) + "]";
}

}  // namespace

std::string palette_module() {
  std::string text = "export const unmatched = " + array_of(kUnmatchedColor) + ";\nexport const palette = [";
  for (int i = 0; i < kColors; ++i) {
    text += (i > 0 ? "," : "") + array_of(nearness_color(static_cast<double>(i) / (kColors - 1)));
  }
  return text + "];\n";
}

}  // namespace stereod::tools
