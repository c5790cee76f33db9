// SPDX-License-Identifier: BSD-3-Clause
#include "calib/live/frame_feed.h"

#include <string>

namespace stereod::calib {

namespace {

GrayImage copied(const LumaView& luma) {
  GrayImage image(luma.size);
  for (int y = 0; y < luma.size.height; ++y) {
    const std::uint8_t* from = luma.data + y * luma.row_stride;
    std::uint8_t* to = image.row(y);
    for (int x = 0; x < luma.size.width; ++x) to[x] = from[x * luma.pixel_stride];
  }
  return image;
}

}  // namespace

CameraFeed::CameraFeed(const Config& config) : capture_(config.cameras, open_stereo_source(config)) {
  capture_.start();
}

std::optional<ImagePair> CameraFeed::next(std::chrono::milliseconds timeout) {
  PairQueue& queue = capture_.pair_queue();
  const std::optional<LeasedPair> pair = queue.wait_pair_for(timeout);
  finished_ = queue.is_finished();
  if (!pair) return std::nullopt;
  ++taken_;
  return ImagePair{"pair " + std::to_string(taken_), copied(pair->left.frame().luma),
                   copied(pair->right.frame().luma)};
}

}  // namespace stereod::calib
