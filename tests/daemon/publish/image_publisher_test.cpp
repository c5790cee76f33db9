// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/publish/image_publisher.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string_view>
#include <thread>

#include "daemon/pipeline/pipeline.h"

namespace stereod {
namespace {

constexpr std::int64_t kMs = 1'000'000;

/// Waits until the images are sent, as at camera rates they are.
bool claim_and_send(ImagePublisher& publisher, std::int64_t now_ns) {
  const std::int64_t sent = publisher.refused();
  if (!publisher.claim(now_ns)) return false;
  publisher.submit();
  while (publisher.refused() == sent) std::this_thread::yield();
  // The sending thread may still be about to release the buffers.
  std::this_thread::sleep_for(std::chrono::microseconds(200));
  return true;
}

/// Counts each set of images as refused, so that the test sees when it was sent.
int refuse() { return 1; }

TEST(ImagePublisher, StreamAtMaximumRate_EveryFrame) {
  ImagePublisher publisher(30, refuse);
  constexpr std::int64_t kJitter[] = {0, -6 * kMs, 5 * kMs, -2 * kMs, 7 * kMs, -7 * kMs, 1 * kMs};
  int sent = 0;
  for (int frame = 0; frame < 70; ++frame) {
    sent += claim_and_send(publisher, 1000 * kMs + frame * 1'000'000'000LL / 30 + kJitter[frame % 7]) ? 1 : 0;
  }
  EXPECT_EQ(sent, 70);
}

TEST(ImagePublisher, FasterStream_MaximumRate) {
  ImagePublisher publisher(30, refuse);
  int sent = 0;
  for (int frame = 0; frame < 240; ++frame) {
    sent += claim_and_send(publisher, 1000 * kMs + frame * 1'000'000'000LL / 120) ? 1 : 0;
  }
  EXPECT_GE(sent, 59);
  EXPECT_LE(sent, 62);
}

TEST(ImagePublisher, Submitted_NotClaimedUntilSent) {
  std::atomic<bool> release{false};
  ImagePublisher publisher(1000, [&] {
    while (!release) std::this_thread::yield();
    return 0;
  });
  ASSERT_TRUE(publisher.claim(1000 * kMs));
  publisher.submit();
  EXPECT_FALSE(publisher.claim(2000 * kMs));
  release = true;
  while (!publisher.claim(3000 * kMs)) std::this_thread::yield();
  EXPECT_EQ(publisher.refused(), 0);
}

/// Counts raw images and frames.
class CountingBus final : public MessageBus {
 public:
  bool publish(const char* channel, const void*, std::size_t) noexcept override {
    if (std::string_view(channel) == "T_LEFT_RAW") ++raw_images;
    if (std::string_view(channel) == "T_FRAME") ++frames;
    return true;
  }
  std::atomic<int> raw_images{0}, frames{0};
};

// Frames of 30 fps arrive a little early or late, so a rate limit without tolerance skips about every second
// one.
TEST(RawPublisher, RateOfTheCameras_SkipsNoFrame) {
  Config config;
  config.cameras.source = SourceKind::kSynthetic;
  config.cameras.fps = 30;
  config.cameras.width = 64;
  config.cameras.height = 48;
  config.matcher = *matcher_preset("fast");
  config.workers = 1;
  config.lcm.prefix = "T";
  config.lcm.pacing = 0;
  config.lcm.raw_images = true;
  config.lcm.raw_images_per_second = 30;
  CountingBus bus;
  Pipeline pipeline(config, open_stereo_source(config), bus);
  while (bus.frames < 60) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  pipeline.stop();
  // A busy machine may delay a frame by more than the tolerance.
  EXPECT_GE(bus.raw_images, 54) << "of " << bus.frames << " frames";
}

}  // namespace
}  // namespace stereod
