// SPDX-License-Identifier: BSD-3-Clause
// Images of the scene as the camera sends them.
#pragma once

#include <array>

#include "tests/vm/uvcsim/bytes.h"
#include "tests/vm/uvcsim/scene.h"
#include "tests/vm/uvcsim/stream_format.h"

namespace stereod::uvcsim {

/// Returns a JPEG without Huffman tables, as many webcams send it. @throws std::runtime_error
Bytes webcam_jpeg(const GrayImage& image);

/// Caches the images of the loop: on an emulated processor, encoding one takes longer than a frame period.
class SceneImages {
 public:
  explicit SceneImages(Eye eye) : eye_(eye) {}
  /// Returns the bytes of frame @p frame [≥ 0]; valid until the next call.
  const Bytes& get(const StreamFormat& format, std::int64_t frame, int gain_64, int offset);
  /// Encodes the whole loop now.
  void prepare(const StreamFormat& format, int gain_64, int offset);

 private:
  struct Look {
    Encoding encoding;
    Size size;
    int gain_64, offset;
    friend bool operator==(const Look&, const Look&) = default;
  };
  const Eye eye_;
  Look look_{};
  std::array<Bytes, kSceneFrames> loop_;
};

// Damage to a JPEG.
void corrupt_jpeg(Bytes& jpeg);
void change_jpeg_height(Bytes& jpeg, int by);

}  // namespace stereod::uvcsim
