// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/publish/left_publisher.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "core/rectify/rectify_map.h"
#include "daemon/capture/synthetic/synthetic_scene.h"
#include "daemon/imagefile/jpeg_codec.h"
#include "daemon/pipeline/pipeline.h"
#include "tests/support/keeping_bus.h"

namespace stereod {
namespace {

constexpr Size kSize{160, 120};

/// Runs the pipeline until @p images left images were published.
void run(KeepingBus<image_t>& bus, bool enabled, bool jpeg, std::size_t images) {
  Config config;
  config.cameras.source = SourceKind::kSynthetic;
  config.cameras.fps = 0;
  config.cameras.width = kSize.width;
  config.cameras.height = kSize.height;
  config.workers = 3;
  config.lcm.prefix = "T";
  config.lcm.pacing = 0;
  config.lcm.left_image = {enabled, jpeg, 240};
  Pipeline pipeline(config, open_stereo_source(config), bus);
  while (bus.messages().size() < images || bus.frames().size() < 8) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

/// Returns the rectified left image of a frame; frames are numbered as in the scene.
GrayImage rectified(const SyntheticScene& scene, std::int64_t frame) {
  const GrayImage raw = scene.render_left(static_cast<int>(frame % scene.frames()));
  GrayImage left(kSize);
  RectifyMap(scene.calibration().left, {kSize, raw.view().stride(), 1}, RectifyConfig{}.interpolation)
      .gray_rows(raw.row(0), {0, kSize.height}, left.view());
  return left;
}

class LeftImages : public testing::TestWithParam<bool> {};

TEST_P(LeftImages, Enabled_RectifiedImagesOfTheirFrames) {
  const bool is_jpeg = GetParam();
  KeepingBus<image_t> bus("T_LEFT");
  run(bus, true, is_jpeg, 4);
  const SyntheticScene scene(kSize);
  int compared = 0;
  for (const image_t& image : bus.messages()) {
    EXPECT_EQ(image.pixelformat, is_jpeg ? 1196444237 : 1497715271);
    EXPECT_EQ(image.row_stride, is_jpeg ? 0 : kSize.width);
    for (const frame_t& frame : bus.frames()) {
      if (frame.utime != image.utime) continue;
      ++compared;
      const GrayImage expected = rectified(scene, frame.frame);
      std::vector<std::uint8_t> pixels(image.data.begin(), image.data.end());
      if (is_jpeg) {
        const auto samples = decode_jpeg("left", image.data, JpegChannels::kLuma).samples;
        pixels.assign(samples.begin(), samples.end());
      }
      ASSERT_EQ(pixels.size(), static_cast<std::size_t>(kSize.width * kSize.height));
      double difference = 0;
      for (int y = 0; y < kSize.height; ++y) {
        for (int x = 0; x < kSize.width; ++x) {
          difference += std::abs(pixels[static_cast<std::size_t>(y * kSize.width + x)] - expected.at(x, y));
        }
      }
      EXPECT_LE(difference / (kSize.width * kSize.height), is_jpeg ? 6.0 : 0.0) << frame.frame;
    }
  }
  EXPECT_GE(compared, 3);
}

INSTANTIATE_TEST_SUITE_P(LeftPublisher, LeftImages, testing::Bool());

TEST(LeftPublisher, Disabled_Silent) {
  KeepingBus<image_t> bus("T_LEFT");
  run(bus, false, true, 0);
  EXPECT_TRUE(bus.messages().empty());
}

}  // namespace
}  // namespace stereod
