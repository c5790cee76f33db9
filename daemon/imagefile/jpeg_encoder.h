// Gray images as JPEG, again and again, by libjpeg-turbo.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/image.h"

namespace stereod {

/// Encodes images of one size. Keeps its memory from image to image.
class JpegEncoder {
 public:
  /// `quality`: 1…100. Throws std::bad_alloc.
  JpegEncoder(Size size, int quality);
  ~JpegEncoder();
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;

  /// The whole file, valid until the next call; empty if libjpeg fails.
  std::span<const std::uint8_t> encode(GrayView picture) noexcept;

 private:
  void* turbo_;
  int quality_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace stereod
