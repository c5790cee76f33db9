// JPEGs as webcams send them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"

namespace stereod {

/// A image as a 4:2:2 color JPEG. Its luma is about `value`, or a gradient if that is negative.
std::vector<std::uint8_t> camera_jpeg(Size size, int value, int restart_rows = 0);

/// The same file without its Huffman tables, as UVC cameras send it.
std::vector<std::uint8_t> without_huffman_tables(const std::vector<std::uint8_t>& jpeg);

}  // namespace stereod
