// SPDX-License-Identifier: BSD-3-Clause
// Decodes buffers that are not 8-bit luma.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/base/image.h"
#include "daemon/capture/v4l2/frame_check.h"

namespace stereod::v4l2 {

/// Decodes JPEGs to luma. One decoder for each camera's thread. Allocates nothing itself; libjpeg allocates a
/// few blocks for each image and frees them with it (docs/cameras.md).
class JpegLumaDecoder {
 public:
  struct Libjpeg;

  /// @throws std::bad_alloc
  JpegLumaDecoder();
  ~JpegLumaDecoder();
  JpegLumaDecoder(const JpegLumaDecoder&) = delete;
  JpegLumaDecoder& operator=(const JpegLumaDecoder&) = delete;

  /// Decodes a JPEG whose size is exactly that of @p luma. Returns false and sets @p drop if the image is
  /// refused; the content of @p luma is then undefined.
  ///
  /// Accepts JPEGs without Huffman tables, which UVC cameras send (the standard tables apply), and up to 100
  /// extraneous bytes before the end of the image or a restart marker. Refuses a header of another size
  /// before decoding, a truncated image (libjpeg would fill it up with gray), and images in several scans.
  bool decode(std::span<const std::uint8_t> jpeg, ImageView<std::uint8_t> luma, FrameDrop& drop) noexcept;

 private:
  void reset() noexcept;

  std::unique_ptr<Libjpeg> jpeg_;
};

/// Converts 16-bit little-endian words with 10 significant bits to 8-bit luma. @p words has as many rows as
/// @p luma, of @p stride bytes each.
void scale_y10(const std::uint8_t* words, std::size_t stride, ImageView<std::uint8_t> luma) noexcept;

}  // namespace stereod::v4l2
