// SPDX-License-Identifier: BSD-3-Clause
// The colors of disparities, for the page.
#pragma once

#include <string>

namespace stereod::tools {

/// Returns a JavaScript module that exports `palette`, 256 colors [r, g, b] from far to near (nearness_color()), and
/// `unmatched`, the color of pixels without a disparity.
std::string palette_module();

}  // namespace stereod::tools
