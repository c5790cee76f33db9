// SPDX-License-Identifier: BSD-3-Clause
// JPEGs as webcams send them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"

namespace stereod {

/// Returns a 4:2:2 color JPEG whose luma is about @p value, or a gradient if @p value is negative. @p
/// restart_rows: rows of blocks between restart markers, 0 = none.
std::vector<std::uint8_t> camera_jpeg(Size size, int value, int restart_rows = 0);

/// Returns the same file without its Huffman tables, as UVC cameras send it.
std::vector<std::uint8_t> without_huffman_tables(const std::vector<std::uint8_t>& jpeg);

}  // namespace stereod
