// SPDX-License-Identifier: BSD-3-Clause
// Publishing a region or a decimated image gives the pixels of the whole image.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "core/match/speckle.h"
#include "daemon/client/stereod_client.h"
#include "daemon/pipeline/pipeline.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/keeping_bus.h"

namespace stereod {
namespace {

constexpr Size kSize{160, 120};
constexpr int kFrames = 3;

Config config_for(const std::string& preset, int workers) {
  Config config;
  config.cameras.source = SourceKind::kSynthetic;
  config.cameras.fps = 0;
  config.cameras.width = kSize.width;
  config.cameras.height = kSize.height;
  config.matcher = *matcher_preset(preset);
  config.matcher.disparities = 40;
  config.workers = workers;
  config.rectify.alpha = 1;  // leaves margins without a source
  config.lcm.prefix = "T";
  config.lcm.rows_per_message = 7;
  config.lcm.pacing = 0;
  return config;
}

/// Returns the first frames that a pipeline publishes, assembled by the client library.
std::vector<StereoFrame> published(const Config& config) {
  KeepingBus<disparity_rows_t> bus("T_DISPARITY");
  {
    Pipeline pipeline(config, open_stereo_source(config), bus);
    while (bus.frames().size() < kFrames) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  std::vector<StereoFrame> frames;
  FrameAssembler assembler([&](StereoFrame&& frame) { frames.push_back(std::move(frame)); });
  const auto messages = bus.messages();
  const auto summaries = bus.frames();
  for (int i = 0; i < kFrames; ++i) {
    for (const disparity_rows_t& rows : messages) {
      if (rows.frame == i) assembler.take(rows);
    }
    assembler.take(summaries[static_cast<std::size_t>(i)]);
  }
  EXPECT_EQ(assembler.counts().messages_ignored, 0);
  EXPECT_EQ(frames.size(), static_cast<std::size_t>(kFrames));
  return frames;
}

class PublishedRegion : public testing::TestWithParam<std::tuple<const char*, int, PublishConfig>> {};

TEST_P(PublishedRegion, AnyRegion_PixelsOfTheWholeImage) {
  const auto& [preset, workers, publish] = GetParam();
  Config config = config_for(preset, workers);
  const int speckle_size = std::exchange(config.matcher.speckle_size, 0);
  const std::vector<StereoFrame> whole = published(config);
  config.matcher.speckle_size = speckle_size;
  config.publish = publish;
  const std::vector<StereoFrame> part = published(config);
  const PublishedPixels pixels(publish, kSize);
  const Size region{pixels.columns().count(), pixels.rows().count()};
  SpeckleFilter speckles(region);
  for (std::size_t i = 0; i < part.size(); ++i) {
    DisparityImage expected(region);
    for (int y = 0; y < region.height; ++y) {
      for (int x = 0; x < region.width; ++x) {
        expected.at(x, y) = whole[i].disparity.at(pixels.left + x, pixels.top + y);
      }
    }
    if (speckle_size > 0) {
      speckles.apply(expected.view(), speckle_size,
                     config.matcher.speckle_max_diff * config.matcher.units_per_pixel());
    }
    ASSERT_TRUE(part[i].complete());
    ASSERT_EQ(part[i].disparity.width(), pixels.width);
    ASSERT_EQ(part[i].disparity.height(), pixels.height);
    EXPECT_EQ(part[i].grid,
              (PixelGrid{publish.left, publish.top, publish.decimation_x, publish.decimation_y}));
    int measured = 0;
    for (int v = 0; v < pixels.height; ++v) {
      for (int u = 0; u < pixels.width; ++u) {
        const int value = part[i].disparity.at(u, v);
        measured += value >= 0 ? 1 : 0;
        ASSERT_EQ(value, expected.at(u * publish.decimation_x, v * publish.decimation_y)) << u << ", " << v;
      }
    }
    EXPECT_FLOAT_EQ(part[i].summary->measured_fraction,
                    static_cast<float>(measured) / static_cast<float>(pixels.width * pixels.height));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Pipeline, PublishedRegion,
    testing::Combine(testing::Values("thesis", "fast", "robust", "dense"), testing::Values(1, 3),
                     testing::Values(PublishConfig{70, 30, 40, 31, 1, 1}, PublishConfig{0, 0, 0, 0, 2, 3},
                                     PublishConfig{100, 0, 0, 50, 3, 1}, PublishConfig{5, 113, 29, 0, 1, 2},
                                     PublishConfig{83, 47, 1, 1, 1, 1})));

TEST(PublishedPixels, RegionOutsideImage_Refused) {
  const auto fits = [](int left, int top, int width, int height) {
    return !region_problem({left, top, width, height, 1, 1}, {640, 480});
  };
  EXPECT_TRUE(fits(0, 0, 0, 0));
  EXPECT_TRUE(fits(0, 0, 640, 480));
  EXPECT_TRUE(fits(639, 479, 1, 1));
  EXPECT_TRUE(fits(639, 479, 0, 0));
  EXPECT_FALSE(fits(640, 0, 0, 0));
  EXPECT_FALSE(fits(0, 480, 0, 0));
  EXPECT_FALSE(fits(1, 0, 640, 0));
  EXPECT_FALSE(fits(0, 400, 0, 81));
  EXPECT_EQ(
      *region_problem({600, 0, 100, 0, 1, 1}, {640, 480}),
      "found 100×0 px at column 600, row 0 (0: up to the edge), allowed: a region inside the image of 640×480 px");
  Config config = config_for("fast", 1);
  config.publish.top = kSize.height;
  KeepingBus<disparity_rows_t> bus("T_DISPARITY");
  EXPECT_THROW(Pipeline(config, open_stereo_source(config), bus), std::invalid_argument);
}

TEST(PublishedPixels, BlockMatcher_FewerColumns) {
  MatcherOptions options = *matcher_preset("fast");
  options.disparities = 64;
  const ColumnRange matched = columns_to_match(options, {640, 480}, {400, 420});
  EXPECT_GT(matched.first, 300);
  EXPECT_LT(matched.end, 500);
  // The semi-global matcher's paths go along whole rows.
  const ColumnRange all = columns_to_match(*matcher_preset("robust"), {640, 480}, {400, 420});
  EXPECT_EQ(all.first, 0);
  EXPECT_EQ(all.end, 640);
}

// A region of the disparities does not cut the left image.
TEST(RegionOutputs, LeftImage_Whole) {
  const auto left_images = [](const PublishConfig& publish) {
    Config config = config_for("robust", 2);
    config.publish = publish;
    config.lcm.left_image = {true, false, 240};
    KeepingBus<image_t> bus("T_LEFT");
    Pipeline pipeline(config, open_stereo_source(config), bus);
    while (bus.messages().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    pipeline.stop();
    return bus.messages();
  };
  const image_t whole = left_images({}).front(), part = left_images({60, 40, 50, 20, 2, 2}).front();
  EXPECT_EQ(part.width, kSize.width);
  EXPECT_EQ(part.height, kSize.height);
  EXPECT_TRUE(part.data == whole.data) << "both are of the first frame";
}

TEST(RegionOutputs, PerFrame_NoAllocation) {
  if (!AllocationCounter::supported()) GTEST_SKIP() << "allocations cannot be counted in this build";
  Config config = config_for("robust", 2);
  config.publish = {40, 20, 100, 60, 2, 2};
  class CountingBus final : public MessageBus {
   public:
    bool publish(const char* channel, const void*, std::size_t) noexcept override {
      if (std::string_view(channel) == "T_FRAME") ++frames;
      return true;
    }
    std::atomic<int> frames{0};
  } bus;
  Pipeline pipeline(config, open_stereo_source(config), bus);
  const auto wait_for = [&](int frames) {
    while (bus.frames < frames) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  };
  wait_for(3);
  const AllocationCounter counter;
  wait_for(bus.frames + 20);
  EXPECT_EQ(counter.count(), 0u);
}

}  // namespace
}  // namespace stereod
