// SPDX-License-Identifier: BSD-3-Clause
// The prefilter: horizontal gradients.
#pragma once

#include <cstdint>

namespace stereod {

/// Writes the horizontal Sobel gradient of one row, clipped to ±@p cap [1…63] and shifted to 0…2·cap
/// (docs/matcher.md, section 1; as OpenCV's StereoBM::PREFILTER_XSOBEL). All rows have @p width [≥ 1] pixels;
/// beyond the top and the bottom of the image the caller passes the mirrored row.
void xsobel_row(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int width,
                int cap, std::uint8_t* out) noexcept;

}  // namespace stereod
