// SPDX-License-Identifier: BSD-3-Clause
// The depth outputs: rows in millimeters, and points.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/geometry/depth.h"
#include "daemon/capture/synthetic/synthetic_scene.h"
#include "daemon/client/stereod_client.h"
#include "daemon/pipeline/pipeline.h"
#include "daemon/publish/cloud_publisher.h"
#include "daemon/publish/depth_publisher.h"
#include "stereod/pointcloud_t.hpp"
#include "tests/support/allocation_counter.h"
#include "tests/support/keeping_bus.h"

namespace stereod {
namespace {

constexpr Size kSize{160, 120};

MatcherOptions options() {
  MatcherOptions options = *matcher_preset("robust");
  options.disparities = 40;
  return options;
}

/// Returns an image with every disparity, and with missing and filled pixels.
DisparityImage all_disparities() {
  DisparityImage image(kSize);
  int value = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const auto disparity = static_cast<std::int16_t>(value++ % (40 * 16));
      image.at(x, y) = x % 7 == 3 ? kInvalidDisparity : x % 7 == 5 ? as_filled(disparity) : disparity;
    }
  }
  return image;
}

FrameTiming timing_of(std::int64_t frame) {
  FrameTiming timing;
  timing.frame = frame;
  timing.utime = 1'700'000'000'000'000 + frame;
  return timing;
}

/// Returns the value to be published for a pixel.
int depth_mm(const Calibration& calibration, int units) {
  if (units < 0) return 0;
  const double mm = 1000 * stereod::depth_m(calibration, units / 16.0);
  return mm > 65534.5 ? 65535 : static_cast<int>(std::lround(mm));
}

/// Passes published rows to an output that reads no other rows.
void take_rows(RowConsumer& consumer, const FrameTiming& timing, DisparityView disparity,
               RowRange published) {
  consumer.take_rows({timing, disparity, published, {}});
}

int value_of(const depth_rows_t& rows, int u, int v) {
  const auto at = static_cast<std::size_t>(2 * ((v - rows.first_row) * rows.width + u));
  return rows.data[at] | rows.data[at + 1] << 8;
}

TEST(DepthPublisher, MeasuredPixels_Millimeters) {
  const Calibration calibration = SyntheticScene(kSize).calibration();
  const DisparityImage image = all_disparities();
  const PublishedPixels pixels({10, 20, 140, 90, 3, 2}, kSize);
  KeepingBus<depth_rows_t> bus("T_DEPTH");
  DepthPublisher publisher(bus, "T", calibration, options(), pixels, 16);
  take_rows(publisher, timing_of(5), image.view(), {16, 32});
  EXPECT_EQ(publisher.refused(), 0);
  ASSERT_EQ(bus.messages().size(), 1U);
  const depth_rows_t rows = bus.messages()[0];
  EXPECT_EQ(rows.frame, 5);
  EXPECT_EQ(rows.utime, timing_of(5).utime);
  EXPECT_EQ(rows.width, 47);
  EXPECT_EQ(rows.height, 45);
  EXPECT_EQ(rows.left, 10);
  EXPECT_EQ(rows.top, 20);
  EXPECT_EQ(rows.decimation_x, 3);
  EXPECT_EQ(rows.decimation_y, 2);
  EXPECT_EQ(rows.first_row, 16);
  EXPECT_EQ(rows.row_count, 16);
  ASSERT_EQ(rows.size, 47 * 16 * 2);
  int known = 0;
  for (int v = 16; v < 32; ++v) {
    for (int u = 0; u < 47; ++u) {
      const int expected = depth_mm(calibration, image.at(10 + 3 * u, 20 + 2 * v));
      known += expected > 0 ? 1 : 0;
      ASSERT_EQ(value_of(rows, u, v), expected) << u << ", " << v;
    }
  }
  EXPECT_GT(known, 400);
}

TEST(DepthPublisher, Horizon_Farthest) {
  Calibration calibration = SyntheticScene(kSize).calibration();
  calibration.right.projection.cx = calibration.left.projection.cx;
  DisparityImage image(kSize);
  image.at(1, 0) = 16 * 30;
  KeepingBus<depth_rows_t> bus("T_DEPTH");
  DepthPublisher publisher(bus, "T", calibration, options(), PublishedPixels(kSize), 1);
  take_rows(publisher, timing_of(0), image.view(), {0, 1});
  EXPECT_EQ(value_of(bus.messages()[0], 0, 0), DepthPublisher::kFarthest);
  EXPECT_LT(value_of(bus.messages()[0], 1, 0), 10'000);
}

TEST(CloudPublisher, Decimated_OnePointPerMeasuredPixel) {
  const Calibration calibration = SyntheticScene(kSize).calibration();
  const DisparityImage image = all_disparities();
  const PublishedPixels pixels({20, 8, 100, 100, 2, 2}, kSize);
  KeepingBus<pointcloud_t> bus("T_CLOUD");
  CloudPublisher publisher(bus, "T", calibration, options(), pixels, 5);
  const auto publish = [&](std::int64_t frame) {
    const FrameTiming timing = timing_of(frame);
    publisher.take_rows({timing, image.view(), {0, pixels.height}, pixels.rows()});
    const std::size_t bytes = publisher.bytes_at_end();
    publisher.end_frame(timing);
    EXPECT_EQ(publisher.refused(), 0);
    EXPECT_EQ(static_cast<std::size_t>(bus.messages().back().getEncodedSize()), bytes);
  };
  publish(1);
  publish(2);  // starts without points
  const RectifiedProjection& p = calibration.left.projection;
  for (std::int64_t frame = 1; frame <= 2; ++frame) {
    const pointcloud_t cloud = bus.messages()[static_cast<std::size_t>(frame - 1)];
    EXPECT_EQ(cloud.utime, timing_of(frame).utime);
    EXPECT_EQ(cloud.seq, frame);
    EXPECT_EQ(cloud.frame_id, "stereo_left");
    EXPECT_EQ(cloud.n_channels, 0);
    ASSERT_EQ(cloud.points.size(), static_cast<std::size_t>(cloud.n_points));
    std::size_t next = 0;
    for (int y = 8; y < pixels.rows().end; y += 5) {
      for (int x = 20; x < pixels.columns().end; x += 5) {
        const double z = image.at(x, y) < 0 ? 0 : stereod::depth_m(calibration, image.at(x, y) / 16.0);
        if (z == 0 || !std::isfinite(z)) continue;
        ASSERT_LT(next, cloud.points.size());
        const auto& point = cloud.points[next++];
        EXPECT_FLOAT_EQ(point[0], static_cast<float>((x - p.cx) / p.fx * z));
        EXPECT_FLOAT_EQ(point[1], static_cast<float>((y - p.cy) / p.fy * z));
        EXPECT_FLOAT_EQ(point[2], static_cast<float>(z));
      }
    }
    EXPECT_EQ(next, cloud.points.size());
    EXPECT_GT(next, 200U);
  }
}

TEST(DepthOutputs, AfterConstruction_NoAllocation) {
  if (!AllocationCounter::supported()) GTEST_SKIP() << "this build does not count allocations";
  class Nowhere final : public MessageBus {
    bool publish(const char*, const void*, std::size_t) noexcept override { return false; }
  } bus;
  const Calibration calibration = SyntheticScene(kSize).calibration();
  const DisparityImage image = all_disparities();
  DepthPublisher depth(bus, "T", calibration, options(), PublishedPixels(kSize), 16);
  CloudPublisher cloud(bus, "T", calibration, options(), PublishedPixels(kSize), 1);
  const AllocationCounter counter;
  for (int i = 0; i < 3; ++i) {
    const FrameTiming timing = timing_of(i);
    take_rows(depth, timing, image.view(), {16, 32});
    EXPECT_EQ(depth.refused(), i + 1);
    cloud.take_rows({timing, image.view(), {0, kSize.height}, {0, kSize.height}});
    cloud.end_frame(timing);
    EXPECT_EQ(cloud.refused(), i + 1);
  }
  EXPECT_EQ(counter.count(), 0U);
}

/// Counts the messages of every channel; refuses them if `refuse` is set.
class CountingBus final : public MessageBus {
 public:
  bool publish(const char* channel, const void*, std::size_t) noexcept override {
    const std::lock_guard lock(mutex_);
    ++counts_[channel];
    return !refuse;
  }
  int count(const std::string& channel) {
    const std::lock_guard lock(mutex_);
    return counts_[channel];
  }
  std::atomic<bool> refuse{false};

 private:
  std::mutex mutex_;
  std::map<std::string, int> counts_;
};

Config pipeline_config(bool depth, bool cloud) {
  Config config;
  config.cameras.source = SourceKind::kSynthetic;
  config.cameras.fps = 0;
  config.cameras.width = kSize.width;
  config.cameras.height = kSize.height;
  config.matcher = options();
  config.lcm.prefix = "T";
  config.lcm.pacing = 0;
  config.publish.depth = depth;
  config.publish.cloud = cloud;
  return config;
}

TEST(DepthOutputs, Enabled_EveryFrame) {
  for (const bool wanted : {false, true}) {
    CountingBus bus;
    Pipeline pipeline(pipeline_config(wanted, wanted), open_stereo_source(pipeline_config(wanted, wanted)),
                      bus);
    while (bus.count("T_FRAME") < 4) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    pipeline.stop();
    if (wanted) {
      EXPECT_GE(bus.count("T_CLOUD"), 3);
      EXPECT_GE(bus.count("T_DEPTH"), bus.count("T_DISPARITY") - 1);
    } else {
      EXPECT_EQ(bus.count("T_CLOUD") + bus.count("T_DEPTH"), 0);
    }
  }
}

TEST(DepthOutputs, Refused_Counted) {
  CountingBus bus;
  bus.refuse = true;
  Pipeline pipeline(pipeline_config(true, true), open_stereo_source(pipeline_config(true, true)), bus);
  while (bus.count("T_CLOUD") < 3) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  pipeline.stop();
  const int sent =
      bus.count("T_FRAME") + bus.count("T_DISPARITY") + bus.count("T_DEPTH") + bus.count("T_CLOUD");
  // The stats do not include a frame that was interrupted by stop().
  EXPECT_GE(pipeline.take_stats().published.messages_refused, sent - (1 + 8 + 8 + 1));
  EXPECT_GE(pipeline.take_stats().published.messages_refused, 2 * (1 + 8 + 8 + 1));
}

TEST(DepthOutputs, RowsTooLarge_Refused) {
  Config config = pipeline_config(true, false);
  config.matcher = *matcher_preset("fast");
  config.matcher.subpixel = false;  // one byte per disparity, two per depth
  config.lcm.rows_per_message = 250;
  EXPECT_THROW(check_pipeline(config, kSize), std::invalid_argument);
  config.publish.depth = false;
  EXPECT_NO_THROW(check_pipeline(config, kSize));
}

}  // namespace
}  // namespace stereod
