// Buffers that are not 8-bit luma yet.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/base/image.h"
#include "daemon/capture/v4l2/frame_check.h"

namespace stereod {

/// Decodes JPEGs to luma; one for each camera's thread. Allocates nothing itself; libjpeg takes a few blocks
/// for each image and gives them back (docs/cameras.md).
class JpegLumaDecoder {
 public:
  struct Libjpeg;

  /// Throws std::bad_alloc.
  JpegLumaDecoder();
  ~JpegLumaDecoder();
  JpegLumaDecoder(const JpegLumaDecoder&) = delete;
  JpegLumaDecoder& operator=(const JpegLumaDecoder&) = delete;

  /// Decodes a JPEG of just the size of `luma`. JPEGs without Huffman tables, as UVC cameras send them, get
  /// the standard ones. A header of another size is refused before anything is decoded; a truncated image,
  /// which libjpeg would fill up with gray, after; images in several scans are
  /// taken for damaged. Bytes too many before the end or before a restart marker do not matter. False: `drop`
  /// says why, and the image is undefined.
  bool decode(std::span<const std::uint8_t> jpeg, ImageView<std::uint8_t> luma, FrameDrop& drop) noexcept;

 private:
  void start_anew() noexcept;

  std::unique_ptr<Libjpeg> jpeg_;
};

/// 16-bit little-endian words with 10 significant bits to 8-bit luma. `words` has rows of `stride` bytes, as
/// many as `luma`.
void scale_y10(const std::uint8_t* words, std::size_t stride, ImageView<std::uint8_t> luma) noexcept;

}  // namespace stereod
