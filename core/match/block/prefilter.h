// What a image goes through before it is compared.
#pragma once

#include <cstdint>

namespace stereod {

/// The horizontal Sobel gradient of one row, clipped to ±cap and shifted to 0…2·cap (docs/matcher.md, section
/// 1; the same as OpenCV's StereoBM::PREFILTER_XSOBEL). The rows are `width` ≥ 1 pixels; at the image's edge
/// the caller passes the mirrored row.
void xsobel_row(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int width,
                int cap, std::uint8_t* out) noexcept;

}  // namespace stereod
