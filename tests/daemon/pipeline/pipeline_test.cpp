// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pipeline/pipeline.h"

#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <cstring>
#include <map>
#include <mutex>
#include <vector>

#include "core/match/frame_matcher.h"
#include "daemon/capture/synthetic/synthetic_scene.h"
#include "daemon/lcm/message_decoder.h"
#include "tests/support/allocation_counter.h"

namespace stereod {
namespace {

constexpr Size kSize{160, 120};

/// Counts what is published, and keeps it if `keep`.
class FakeBus final : public MessageBus {
 public:
  explicit FakeBus(bool keep) : keep_(keep) {}

  bool publish(const char* channel, const void* data, std::size_t size) noexcept override {
    const std::lock_guard lock(mutex_);
    if (std::strstr(channel, "_FRAME") != nullptr) ++frames_;
    if (keep_ && std::strstr(channel, "_FRAME") != nullptr) decode(data, size, frame_messages_);
    if (keep_ && std::strstr(channel, "_DISPARITY") != nullptr) decode(data, size, row_messages_);
    if (std::strstr(channel, "_RAW") != nullptr) {
      ++raw_images_;
      if (keep_) decode(data, size, raw_images_of_[channel]);
    }
    changed_.notify_all();
    return !refuse_;
  }

  void wait_for_frames(int count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return frames_ >= count; });
  }

  void wait_for_more_frames(int count) {
    std::unique_lock lock(mutex_);
    const int enough = frames_ + count;
    changed_.wait(lock, [&] { return frames_ >= enough; });
  }

  std::vector<frame_t> frame_messages() {
    const std::lock_guard lock(mutex_);
    return frame_messages_;
  }
  std::vector<disparity_rows_t> row_messages() {
    const std::lock_guard lock(mutex_);
    return row_messages_;
  }
  std::vector<image_t> raw_images(const std::string& channel) {
    const std::lock_guard lock(mutex_);
    return raw_images_of_[channel];
  }
  int raw_images_seen() {
    const std::lock_guard lock(mutex_);
    return raw_images_;
  }
  void wait_for_raw_images(int count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return raw_images_ >= count; });
  }
  void refuse() { refuse_ = true; }

 private:
  template <typename Message>
  static void decode(const void* data, std::size_t size, std::vector<Message>& messages) {
    EXPECT_TRUE(decode_message({static_cast<const std::byte*>(data), size}, messages.emplace_back()));
  }

  const bool keep_;
  std::atomic<bool> refuse_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  int frames_ = 0;
  int raw_images_ = 0;
  std::map<std::string, std::vector<image_t>> raw_images_of_;
  std::vector<frame_t> frame_messages_;
  std::vector<disparity_rows_t> row_messages_;
};

Config config_for(const char* preset, int workers) {
  Config config;
  config.cameras.source = SourceKind::kSynthetic;
  config.cameras.fps = 0;
  config.cameras.width = kSize.width;
  config.cameras.height = kSize.height;
  config.matcher = *matcher_preset(preset);
  config.matcher.disparities = 40;
  config.workers = workers;
  config.lcm.rows_per_message = 7;
  config.lcm.pacing = 0;
  return config;
}

/// Returns the disparities of the same frame from the same matcher, without the pipeline.
DisparityImage expected_disparity(const Config& config, std::int64_t frame) {
  const SyntheticScene scene(kSize);
  const int number = static_cast<int>(frame % scene.frames());
  const SourceLayout layout{kSize, scene.render_left(number).view().stride(), 1};
  const GrayImage raw_left = scene.render_left(number);
  const GrayImage raw_right = scene.render_right(number);
  GrayImage left(kSize);
  GrayImage right(kSize);
  const RectifyMap left_map(scene.calibration().left, layout, config.rectify.interpolation);
  const RectifyMap right_map(scene.calibration().right, layout, config.rectify.interpolation);
  left_map.gray_rows(raw_left.row(0), {0, kSize.height}, left.view());
  right_map.gray_rows(raw_right.row(0), {0, kSize.height}, right.view());
  const ValidityMask left_mask = left_map.mask();
  const ValidityMask right_mask = right_map.mask();
  WorkerPool pool(1);
  DisparityImage disparity(kSize);
  FrameMatcher matcher(config.matcher, kSize, pool);
  matcher.use_masks(&left_mask, &right_mask);
  matcher.match(left.view(), right.view(), disparity.view());
  return disparity;
}

int wire_value(const disparity_rows_t& message, int row, int x) {
  const std::size_t at = static_cast<std::size_t>(row * message.width + x);
  if (message.bytes_per_value == 1) return message.data[at];
  return message.data[2 * at] | message.data[2 * at + 1] << 8;
}

bool wire_filled(const disparity_rows_t& message, int row, int x) {
  if (message.filled.empty()) return false;
  const std::size_t row_bytes = static_cast<std::size_t>((message.width + 7) / 8);
  return (message.filled.at(static_cast<std::size_t>(row) * row_bytes + static_cast<std::size_t>(x / 8)) >>
              (x % 8) &
          1) != 0;
}

class PipelineOutput : public testing::TestWithParam<std::tuple<const char*, int>> {};

TEST_P(PipelineOutput, AnyWorkers_EveryRowExact) {
  const Config config = config_for(std::get<0>(GetParam()), std::get<1>(GetParam()));
  constexpr int kFrames = 6;
  FakeBus bus(true);
  {
    Pipeline pipeline(config, open_stereo_source(config), bus);
    bus.wait_for_frames(kFrames);
    pipeline.stop();
  }
  std::map<std::int64_t, std::vector<int>> seen;  // by frame: how often each row was published
  std::map<std::int64_t, DisparityImage> expected;
  for (const disparity_rows_t& message : bus.row_messages()) {
    if (message.frame >= kFrames) continue;
    if (expected.count(message.frame) == 0) {
      expected.emplace(message.frame, expected_disparity(config, message.frame));
    }
    std::vector<int>& rows = seen[message.frame];
    rows.resize(static_cast<std::size_t>(kSize.height));
    ASSERT_EQ(message.size, message.width * message.row_count * message.bytes_per_value);
    EXPECT_EQ(message.bytes_per_value, config.matcher.subpixel ? 2 : 1);
    for (int row = 0; row < message.row_count; ++row) {
      const int y = message.first_row + row;
      ++rows.at(static_cast<std::size_t>(y));
      for (int x = 0; x < kSize.width; ++x) {
        const std::int16_t found = expected.at(message.frame).at(x, y);
        const int want = is_filled(found) ? filled_disparity(found) : found;
        ASSERT_EQ(wire_value(message, row, x), want == kInvalidDisparity ? message.invalid : want)
            << "frame " << message.frame << ", pixel (" << x << ", " << y << ")";
        ASSERT_EQ(wire_filled(message, row, x), is_filled(found))
            << "frame " << message.frame << ", pixel (" << x << ", " << y << ")";
      }
    }
  }
  ASSERT_EQ(seen.size(), static_cast<std::size_t>(kFrames));
  for (const auto& [frame, rows] : seen)
    EXPECT_EQ(rows, std::vector<int>(rows.size(), 1)) << "frame " << frame;

  const std::vector<frame_t> frames = bus.frame_messages();
  for (int i = 0; i < kFrames; ++i) {
    const frame_t& frame = frames.at(static_cast<std::size_t>(i));
    EXPECT_EQ(frame.frame, i);
    EXPECT_EQ(frame.left_sequence, i) << "a source without rate limit loses no frame";
    EXPECT_EQ(frame.right_sequence, i);
    EXPECT_EQ(frame.skew_us, 0);
    EXPECT_EQ(frame.rows, kSize.height);
    int valid = 0;
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) valid += expected.at(i).at(x, y) >= 0 ? 1 : 0;
    }
    EXPECT_FLOAT_EQ(frame.measured_fraction, static_cast<float>(valid) / (kSize.width * kSize.height));
  }
}

INSTANTIATE_TEST_SUITE_P(Pipeline, PipelineOutput,
                         testing::Combine(testing::Values("thesis", "fast", "robust", "dense", "fine"),
                                          testing::Values(1, 2, 5)));

TEST(Pipeline, MessagesOfAFrame_SameUtime) {
  const Config config = config_for("fast", 2);
  FakeBus bus(true);
  Pipeline pipeline(config, open_stereo_source(config), bus);
  bus.wait_for_frames(3);
  pipeline.stop();
  const std::vector<frame_t> frames = bus.frame_messages();
  for (const disparity_rows_t& rows : bus.row_messages()) {
    if (rows.frame < 3) {
      EXPECT_EQ(rows.utime, frames.at(static_cast<std::size_t>(rows.frame)).utime);
    }
  }
}

TEST(Pipeline, PerFrame_NoAllocation) {
  if (!AllocationCounter::supported()) GTEST_SKIP() << "allocations cannot be counted in this build";
  for (const char* preset : {"thesis", "fast", "robust", "dense", "fine"}) {
    for (const Implementation implementation :
         {Implementation::kNaive, Implementation::kSliding, Implementation::kSimd}) {
      Config config = config_for(preset, 2);
      // The semi-global reference is for tests only.
      const bool semiglobal = config.matcher.method == Method::kSemiglobal;
      if (semiglobal && implementation != Implementation::kSimd) continue;
      config.matcher.implementation = implementation;
      config.matcher.disparities = 16;
      FakeBus bus(false);
      Pipeline pipeline(config, open_stereo_source(config), bus);
      bus.wait_for_frames(3);
      const AllocationCounter counter;
      bus.wait_for_more_frames(20);
      EXPECT_EQ(counter.count(), 0u) << preset << ", " << name_of(implementation);
    }
  }
}

TEST(Pipeline, RawImages_CameraImages) {
  Config config = config_for("fast", 1);
  config.lcm.raw_images = true;
  config.lcm.raw_images_per_second = 60;
  FakeBus bus(true);
  {
    Pipeline pipeline(config, open_stereo_source(config), bus);
    bus.wait_for_raw_images(6);
    pipeline.stop();
  }
  const std::vector<image_t> left = bus.raw_images("STEREO_LEFT_RAW");
  const std::vector<image_t> right = bus.raw_images("STEREO_RIGHT_RAW");
  ASSERT_GE(left.size(), 3u);
  ASSERT_GE(right.size(), 3u);
  const SyntheticScene scene(kSize);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(left[i].utime, right[i].utime) << "images of a pair have equal times";
    for (const image_t* image : {&left[i], &right[i]}) {
      EXPECT_EQ(image->width, kSize.width);
      EXPECT_EQ(image->height, kSize.height);
      EXPECT_EQ(image->row_stride, kSize.width);
      EXPECT_EQ(image->pixelformat, 1497715271);
      ASSERT_EQ(image->size, kSize.width * kSize.height);
      bool found = false;
      for (int n = 0; n < scene.frames() && !found; ++n) {
        const GrayImage seen = image == &left[i] ? scene.render_left(n) : scene.render_right(n);
        bool same = true;
        for (int y = 0; y < kSize.height && same; ++y) {
          same = std::memcmp(seen.row(y), image->data.data() + y * kSize.width,
                             static_cast<std::size_t>(kSize.width)) == 0;
        }
        found = same;
      }
      EXPECT_TRUE(found) << "the image is not of the scene";
    }
  }
}

// Receivers identify a type by its fingerprint. The two numbers are those of libbot's bot_core types.
TEST(RawImages, Fingerprint_BotCore) {
  const auto turned = [](std::uint64_t hash) { return hash << 1 | hash >> 63; };
  const std::uint64_t metadata = turned(0x4d25b1a682bbfdc7U);
  EXPECT_EQ(static_cast<std::uint64_t>(image_t::getHash()), turned(0x6fee6cb20472ff6aU + metadata));
}

TEST(Pipeline, RawImages_OffByDefaultNoAllocation) {
  for (const bool wanted : {false, true}) {
    Config config = config_for("fast", 1);
    config.lcm.raw_images = wanted || config.lcm.raw_images;
    config.lcm.raw_images_per_second = 60;
    FakeBus bus(false);
    Pipeline pipeline(config, open_stereo_source(config), bus);
    bus.wait_for_frames(3);
    if (wanted) bus.wait_for_raw_images(2);
    const AllocationCounter counter;
    bus.wait_for_more_frames(20);
    if (wanted) bus.wait_for_raw_images(6);
    if (AllocationCounter::supported()) {
      EXPECT_EQ(counter.count(), 0u);
    }
    pipeline.stop();
    EXPECT_EQ(bus.raw_images_seen() > 0, wanted);
  }
}

TEST(Pipeline, StopAnytime_Ends) {
  for (int i = 0; i < 20; ++i) {
    const Config config = config_for("robust", 3);
    FakeBus bus(false);
    Pipeline pipeline(config, open_stereo_source(config), bus);
    if (i > 0) bus.wait_for_frames(i / 4);
    if (i % 2 == 0) pipeline.stop();
  }
}

TEST(Pipeline, Refused_Counted) {
  const Config config = config_for("fast", 1);
  FakeBus bus(false);
  bus.refuse();
  Pipeline pipeline(config, open_stereo_source(config), bus);
  bus.wait_for_frames(3);
  const PipelineStats stats = pipeline.take_stats();
  EXPECT_GE(stats.published.messages_refused, 2 * (120 + 6) / 7);
}

TEST(Pipeline, RowsTooLargeForMessage_Refused) {
  Config config = config_for("fast", 1);
  config.lcm.rows_per_message = 300;
  FakeBus bus(false);
  try {
    Pipeline pipeline(config, open_stereo_source(config), bus);
    FAIL() << "no exception";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "found 300, allowed 1…191: a row has 340 bytes, a message holds 65243");
  }
}

TEST(Pipeline, WideRows_FewerPerMessage) {
  WireFormat format;
  format.disparities = 64;
  format.units_per_pixel = 16;  // two bytes and a bit per value
  EXPECT_EQ(default_rows_per_message(format, 640), 16);
  EXPECT_EQ(default_rows_per_message(format, 1920), 65243 / (2 * 1920 + 240));
  Config config = config_for("fast", 1);
  config.lcm.rows_per_message.reset();
  EXPECT_NO_THROW(check_pipeline(config, {1920, 1080}));
  config.lcm.rows_per_message = 16;
  EXPECT_THROW(check_pipeline(config, {1920, 1080}), std::invalid_argument);
}

TEST(Pipeline, FramesTooFarApart_NoPair) {
  Config config = config_for("fast", 1);
  config.cameras.fps = 100;
  config.cameras.max_skew_ms = 1;
  config.cameras.skew_ms = 4;
  FakeBus bus(false);
  Pipeline pipeline(config, open_stereo_source(config), bus);
  PipelineStats stats;
  while (stats.left.frames < 10 || stats.right.frames < 10) stats = pipeline.take_stats();
  EXPECT_EQ(stats.pairing.pairs, 0);
  EXPECT_GT(stats.pairing.left_without_partner, 0);
}

}  // namespace
}  // namespace stereod
