// SPDX-License-Identifier: BSD-3-Clause
// JPEG encoding and damage.
#include "tests/vm/uvcsim/scene_images.h"

#include <turbojpeg.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

namespace stereod::uvcsim {
namespace {

constexpr std::uint8_t kMarker = 0xff, kStartOfFrame = 0xc0, kHuffmanTables = 0xc4, kStartOfScan = 0xda;

// Calls visit(marker, offset, length of the segment with its marker) for each segment before the scan, until
// it returns false.
template <typename Visit>
void for_each_segment(ByteSpan jpeg, Visit visit) {
  std::size_t at = 2;  // after the start marker
  while (at + 4 <= jpeg.size() && jpeg[at] == kMarker && jpeg[at + 1] != kStartOfScan) {
    const std::size_t length = 2 + (std::size_t{jpeg[at + 2]} << 8 | jpeg[at + 3]);
    if (!visit(jpeg[at + 1], at, length)) return;
    at += length;
  }
}

void drop_huffman_tables(Bytes& jpeg) {
  bool dropped = true;
  while (dropped) {
    dropped = false;
    for_each_segment(jpeg, [&](std::uint8_t marker, std::size_t at, std::size_t length) {
      if (marker != kHuffmanTables) return true;
      const auto begin = jpeg.begin() + static_cast<std::ptrdiff_t>(at);
      jpeg.erase(begin, begin + static_cast<std::ptrdiff_t>(length));
      dropped = true;
      return false;
    });
  }
}

}  // namespace

Bytes webcam_jpeg(const GrayImage& image) {
  constexpr int kQuality = 85;
  const std::unique_ptr<void, int (*)(void*)> encoder(tjInitCompress(), tjDestroy);
  unsigned char* data = nullptr;
  unsigned long size = 0;
  // Webcams send color; empty color planes give the same luma.
  const Bytes colorless(
      static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height()) / 2, 128);
  const unsigned char* planes[3] = {image.row(0), colorless.data(), colorless.data()};
  const int strides[3] = {static_cast<int>(image.view().stride()), image.width() / 2, image.width() / 2};
  if (tjCompressFromYUVPlanes(encoder.get(), planes, image.width(), strides, image.height(), TJSAMP_422,
                              &data, &size, kQuality, 0) != 0) {
    throw std::runtime_error(std::string("JPEG encoding failed: ") + tjGetErrorStr2(encoder.get()));
  }
  Bytes jpeg(data, data + size);
  tjFree(data);
  drop_huffman_tables(jpeg);
  return jpeg;
}

const Bytes& SceneImages::get(const StreamFormat& format, std::int64_t frame, int gain_64, int offset) {
  const Look look{format.encoding, format.size, gain_64, offset};
  if (!(look == look_)) {
    for (Bytes& bytes : loop_) bytes.clear();
    look_ = look;
  }
  const int number = static_cast<int>(frame % kSceneFrames);
  Bytes& bytes = loop_[static_cast<std::size_t>(number)];
  if (bytes.empty()) {
    const GrayImage image = render_scene(eye_, format.size, number, gain_64, offset);
    bytes = format.encoding == Encoding::kMjpeg ? webcam_jpeg(image) : yuyv_bytes(image);
  }
  return bytes;
}

void SceneImages::prepare(const StreamFormat& format, int gain_64, int offset) {
  for (int frame = 0; frame < kSceneFrames; ++frame) get(format, frame, gain_64, offset);
}

void corrupt_jpeg(Bytes& jpeg) {
  constexpr std::uint8_t kRestart = 0xd3;  // an unexpected marker
  const std::size_t middle = jpeg.size() / 2;
  for (std::size_t i = middle; i + 1 < std::min(jpeg.size(), middle + 64); i += 2) {
    jpeg[i] = kMarker;
    jpeg[i + 1] = kRestart;
  }
}

void change_jpeg_height(Bytes& jpeg, int by) {
  for_each_segment(jpeg, [&](std::uint8_t marker, std::size_t at, std::size_t) {
    if (marker != kStartOfFrame) return true;
    const int height = (jpeg[at + 5] << 8 | jpeg[at + 6]) + by;
    jpeg[at + 5] = static_cast<std::uint8_t>(height >> 8);
    jpeg[at + 6] = static_cast<std::uint8_t>(height);
    return false;
  });
}

}  // namespace stereod::uvcsim
