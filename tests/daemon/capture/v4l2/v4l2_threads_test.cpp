// SPDX-License-Identifier: BSD-3-Clause
// Cameras as the daemon runs them: one thread for each camera, one consumer of pairs, one thread that reads
// reports.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "daemon/capture/capture_thread.h"
#include "daemon/capture/pair_queue.h"
#include "tests/support/camera_bench.h"

namespace stereod::v4l2 {
namespace {

using namespace std::chrono_literals;

TEST(V4l2Threads, FaultsAndReplugs_PairsContinue) {
  CameraBench bench(true);
  bench.config.fps = 200;
  bench.config.v4l2.sync = SyncMode::kStart;
  bench.config.v4l2.max_sync_skew_ms = 0.001;  // no start reaches this, not even by chance
  bench.config.v4l2.exposure = ExposureMode::kFollow;
  for (FakeCamera* camera : {bench.left_camera, bench.right_camera}) {
    camera->modes = {{make_fourcc('Y', 'U', 'Y', 'V'), {64, 48}, {200}}};
    camera->start_latency_ns = camera == bench.left_camera ? 3'000'000 : 5'400'000;
  }
  std::mutex log_mutex;
  std::vector<std::string> log;
  const CameraLog to_log = [&](LogLevel, const std::string& line) {
    const std::lock_guard lock(log_mutex);
    log.push_back(line);
  };
  bench.pair = std::make_shared<V4l2PairState>(bench.config);
  bench.left = std::make_unique<V4l2Camera>(bench.video, bench.pair, Side::kLeft, bench.config, to_log);
  bench.right = std::make_unique<V4l2Camera>(bench.video, bench.pair, Side::kRight, bench.config, to_log);

  PairQueue pair_queue(2'500'000, true);
  std::atomic<int> pairs{0};
  std::atomic<bool> done{false};
  {
    CaptureThread left(Side::kLeft, *bench.left, pair_queue);
    CaptureThread right(Side::kRight, *bench.right, pair_queue);
    std::thread matcher([&] {
      unsigned sum = 0;
      const std::atomic<bool> cancelled{false};
      while (std::optional<LeasedPair> pair = pair_queue.wait_pair(cancelled)) {
        const LumaView& luma = pair->left.frame().luma;
        for (int y = 0; y < luma.size.height; ++y) sum += luma.data[y * luma.row_stride];
        std::this_thread::sleep_for(1ms);
        ++pairs;
      }
      EXPECT_GT(sum, 0u);
    });
    std::thread reporter([&] {
      while (!done) {
        left.report();
        right.report();
        bench.pair->sync_report();
        std::this_thread::sleep_for(1ms);
      }
    });
    const auto wait_for_pairs = [&](int more) {
      const int enough = pairs + more;
      while (pairs < enough) std::this_thread::sleep_for(1ms);
    };
    wait_for_pairs(20);
    for (int i = 0; i < 2000 && bench.pair->sync_report().restarts == 0; ++i) wait_for_pairs(1);
    for (int round = 0; round < 4; ++round) {
      FakeCamera& camera = round % 2 == 0 ? *bench.left_camera : *bench.right_camera;
      CaptureThread& thread = round % 2 == 0 ? left : right;
      bench.video.plug(camera, false);
      while (thread.report().state != SourceState::kAbsent) std::this_thread::sleep_for(1ms);
      bench.video.plug(camera, true);
      wait_for_pairs(20);
    }
    left.stop();
    right.stop();
    pair_queue.close();
    matcher.join();
    done = true;
    reporter.join();
    pair_queue.clear();
    EXPECT_GT(bench.pair->sync_report().restarts, 0);
    EXPECT_GE(bench.left->report().reconnects, 2);
    EXPECT_GE(bench.right->report().reconnects, 2);
  }
  bench.left.reset();
  bench.right.reset();
  EXPECT_EQ(bench.video.open_descriptors(), 0);
  EXPECT_EQ(bench.video.mappings(), 0);
}

// The frame of an unplugged camera leaves the pair queue: the camera can only be set up again without frames
// on loan.
TEST(V4l2Threads, Unplug_WaitingFrameGivenBack) {
  CameraBench bench(true);
  bench.right_camera->plugged = false;
  bench.make();
  PairQueue pair_queue(16'000'000, true);
  CaptureThread left(Side::kLeft, *bench.left, pair_queue);
  while (left.frames() < 3) std::this_thread::sleep_for(1ms);
  for (int round = 0; round < 2; ++round) {
    bench.video.plug(*bench.left_camera, false);
    while (left.report().state != SourceState::kAbsent) std::this_thread::sleep_for(1ms);
    bench.video.plug(*bench.left_camera, true);
    const std::int64_t before = left.frames();
    while (left.frames() < before + 3) std::this_thread::sleep_for(1ms);
  }
  EXPECT_EQ(left.report().reconnects, 2);
  left.stop();
  pair_queue.clear();
}

TEST(PairQueue, HalfFrameTolerance_FollowsRate) {
  struct Owner final : BufferOwner {
    void give_back(int) noexcept override {}
  } owner;
  const auto frame = [&](std::int64_t at_ms) {
    Frame f;
    f.captured_ns = at_ms * 1'000'000;
    return FrameLease(f, owner, 0);
  };
  PairQueue pair_queue(16'000'000, true);
  pair_queue.set_frame_time(Side::kLeft, 66'000'000);
  pair_queue.set_frame_time(Side::kRight, 66'000'000);
  pair_queue.add(Side::kLeft, frame(0));
  pair_queue.add(Side::kRight, frame(30));
  EXPECT_EQ(pair_queue.counts().pairs, 1) << "at 15 frames a second 30 ms are less than half a frame";
  PairQueue fixed(16'000'000, false);
  fixed.set_frame_time(Side::kLeft, 66'000'000);
  fixed.add(Side::kLeft, frame(0));
  fixed.add(Side::kRight, frame(30));
  EXPECT_EQ(fixed.counts().pairs, 0) << "what the configuration says stays";
}

}  // namespace
}  // namespace stereod::v4l2
