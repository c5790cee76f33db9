// SPDX-License-Identifier: BSD-3-Clause
// An image as the codecs decode it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "core/base/limits.h"

namespace stereod {

/// An image with the channels and samples of its file, before conversion to what the caller asked for.
struct DecodedImage {
  Size size;
  int channels = 1;                   ///< 1: gray, 3: red, green, blue
  int max_value = 255;                ///< sample of full brightness, 1…65535
  int sample_bytes = 1;               ///< 1, or 2 (host byte order)
  std::vector<std::uint8_t> samples;  ///< row by row without padding

  DecodedImage(Size image_size, int channel_count, int maximum)
      : size(image_size),
        channels(channel_count),
        max_value(maximum),
        sample_bytes(maximum > 255 ? 2 : 1),
        samples(static_cast<std::size_t>(size.height) * row_bytes()) {}

  std::size_t row_bytes() const {
    return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(channels * sample_bytes);
  }
  /// Returns sample @p index, counted from the top left.
  int sample(std::size_t index) const {
    if (sample_bytes == 1) return samples[index];
    std::uint16_t value = 0;
    std::memcpy(&value, &samples[2 * index], 2);
    return value;
  }
  void set_sample(std::size_t index, int value) {
    if (sample_bytes == 1) {
      samples[index] = static_cast<std::uint8_t>(value);
    } else {
      const auto wide = static_cast<std::uint16_t>(value);
      std::memcpy(&samples[2 * index], &wide, 2);
    }
  }
};

/// Throws FileError unless both sides are 1…kMaxImageFileSide px.
void check_image_size(const std::string& file, long long width, long long height);

}  // namespace stereod
