// Images of the scene as a camera sends them.
#pragma once

#include <array>

#include "tests/vm/uvcsim/bytes.h"
#include "tests/vm/uvcsim/scene.h"
#include "tests/vm/uvcsim/stream_format.h"

namespace stereod::uvcsim {

/// A JPEG of the image, without Huffman tables, as many webcams leave them out. Throws std::runtime_error.
Bytes webcam_jpeg(const GrayImage& picture);

/// Keeps the images of the loop, because making one takes longer than a frame on an emulated processor.
class Pictures {
 public:
  explicit Pictures(Eye eye) : eye_(eye) {}
  /// The bytes of a frame ≥ 0; valid until the next call.
  const Bytes& get(const StreamFormat& format, std::int64_t frame, int gain_64, int offset);
  /// Makes all of them now.
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

/// Damage done to a JPEG.
void corrupt_jpeg(Bytes& jpeg);
void change_jpeg_height(Bytes& jpeg, int by);

}  // namespace stereod::uvcsim
