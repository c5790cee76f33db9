// SPDX-License-Identifier: BSD-3-Clause
// Encodes gray images as JPEG with libjpeg-turbo.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/image.h"

namespace stereod {

/// Encodes images of one size. Reuses its memory.
class JpegEncoder {
 public:
  /// @p quality [1…100]. Throws std::bad_alloc.
  JpegEncoder(Size size, int quality);
  ~JpegEncoder();
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;

  /// Returns the JPEG file, valid until the next call; empty if libjpeg fails.
  std::span<const std::uint8_t> encode(GrayView image) noexcept;

 private:
  void* turbo_;
  int quality_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace stereod
