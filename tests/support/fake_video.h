// SPDX-License-Identifier: BSD-3-Clause
// Scripted cameras for tests: V4L2's answers and the time are under control of the test.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "daemon/capture/v4l2/video_device.h"
#include "daemon/capture/v4l2/video_system.h"

namespace stereod::v4l2 {

/// One frame of a fake camera; a script may change it.
struct FakeFrame {
  std::uint32_t sequence = 0;
  std::int64_t timestamp_ns = 0;
  std::uint32_t flags = 0;  ///< V4L2_BUF_FLAG_*
  std::vector<std::uint8_t> bytes;
  std::optional<std::uint32_t> bytesused;  ///< overrides the number of bytes
};

struct FakeMode {
  std::uint32_t fourcc = make_fourcc('Y', 'U', 'Y', 'V');
  Size size{64, 48};
  std::vector<double> rates{30};
};

struct FakeControl {
  std::uint32_t id = 0;
  std::string title;  ///< as the driver reports it: "Exposure Time, Absolute"
  std::int32_t minimum = 0, maximum = 255, default_value = 0, value = 0;
  std::uint32_t type = 1;  ///< V4L2_CTRL_TYPE_INTEGER
  std::uint32_t flags = 0;
};

/// One camera. Public members may be changed at any time while no thread runs.
struct FakeCamera {
  std::string node = "/dev/video0";
  std::vector<std::string> links;
  std::string serial;
  std::string card = "Fake Camera";
  std::string bus = "usb-0000:00:14.0-1";
  std::string function;  ///< the same for two nodes of one USB function; empty = a function of its own
  bool capture = true;   ///< false: a metadata node
  bool plugged = true;
  bool frozen = false;
  bool thaws_at_start =
      false;  ///< a stream that was started or ran while frozen stays silent until the next start
  std::vector<FakeMode> modes{FakeMode{}};
  std::vector<FakeControl> controls;

  /// An error with which the driver answers a request (VIDIOC_*, kFakeOpen, kFakeMap, kFakePoll).
  struct Fault {
    int error = 0;
    int times = 1;  ///< number of failing calls
    int after = 0;  ///< number of successful calls before
  };
  std::map<unsigned long, Fault> faults;
  std::function<void(DeviceFormat&)> on_set_format;  ///< changes the requested format
  std::function<void(FakeFrame&)> on_frame;
  std::function<void(const FakeControl&)> on_set_control;

  std::int64_t period_ns = 33'333'333;               ///< frame period of the sensor; S_PARM sets it
  std::int64_t drift_ppb = 0;                        ///< by which the period is longer
  bool keeps_phase = false;                          ///< the sensor keeps running while the stream is stopped
  std::int64_t phase_ns = 0;                         ///< phase of such a sensor
  std::int64_t start_latency_ns = 50'000'000;        ///< from STREAMON to the first exposure of other sensors
  std::uint32_t timestamp_flags = 0x2000 | 0x10000;  ///< monotonic, start of exposure

  // Records.
  std::vector<std::string> log;  ///< controls that were set: "gain=5"
  int starts = 0, opens = 0;
};

inline constexpr unsigned long kFakeOpen = 1, kFakeMap = 2, kFakePoll = 3;

/// The kernel with fake cameras. Simulated time advances only in waits, which jump to the next event. Real
/// time is that of the clock, for tests with threads.
class FakeVideo final : public VideoSystem {
 public:
  explicit FakeVideo(bool real_time = false) : real_time_(real_time) {}

  /// Capacity of the bus [bytes/s], 0 = unlimited. A stream that exceeds it is refused with ENOSPC or, with
  /// `starve`, starts and never delivers.
  double bus_capacity = 0;
  bool starve = false;

  /// Adds a camera. The reference stays valid.
  FakeCamera& add(FakeCamera camera);
  /// Runs an action at a time (simulated time begins at 1000 s).
  void at(std::int64_t time_ns, std::function<void()> action);
  void plug(FakeCamera& camera, bool plugged);
  int open_descriptors() const { return static_cast<int>(open_.size()); }
  int mappings() const { return mappings_; }
  int waits() const { return waits_; }

  std::vector<VideoNode> nodes() override;
  std::string resolve(const std::string& name) override;
  std::string camera_id(const std::string& node) override;
  std::unique_ptr<Waiter> make_waiter() override;
  int open(const std::string& node, bool convert) override;
  void close(int descriptor) noexcept override;
  int ioctl(int descriptor, unsigned long request, void* argument) noexcept override;
  void* map(int descriptor, std::size_t length, std::int64_t offset, int& error) noexcept override;
  void unmap(void* memory, std::size_t length) noexcept override;
  std::int64_t now_ns() noexcept override;
  void sleep_until(std::int64_t time_ns) noexcept override;

 private:
  class FakeWaiter;
  struct Opened {
    FakeCamera* camera = nullptr;
    DeviceFormat format;
    bool convert = false;
    bool streaming = false;
    bool starved = false;
    bool stuck = false;         // until the next start
    bool no_buffer_yet = true;  // no buffer was queued since the last stop
    bool unplugged = false;
    std::vector<std::vector<std::uint8_t>> buffers;
    std::deque<std::uint32_t> queued;
    struct Filled {
      std::uint32_t index;
      FakeFrame frame;
    };
    std::deque<Filled> filled;
    std::int64_t next_ns = 0;
    std::uint32_t sequence = 0;
  };

  WaitResult wait(int descriptor, std::int64_t timeout_ns, FakeWaiter& waiter);
  bool ready(int descriptor, WaitResult& result);
  void run_until(std::int64_t time_ns);
  std::int64_t next_event(std::int64_t limit_ns) const;
  void deliver(Opened& opened);
  bool scripted_error(FakeCamera& camera, unsigned long request, int& error) noexcept;
  int answer(Opened& opened, unsigned long request, void* argument);
  int answer_listing(Opened& opened, unsigned long request, void* argument);
  int answer_buffers(Opened& opened, unsigned long request, void* argument);
  int answer_controls(Opened& opened, unsigned long request, void* argument);
  int stream_on(Opened& opened);
  double traffic() const;

  const bool real_time_;
  mutable std::recursive_mutex mutex_;
  std::int64_t now_ns_ = 1'000'000'000'000;
  std::multimap<std::int64_t, std::function<void()>> actions_;
  std::vector<std::unique_ptr<FakeCamera>> cameras_;
  std::map<int, Opened> open_;
  int next_descriptor_ = 100;
  int mappings_ = 0;
  int waits_ = 0;
  std::uint64_t device_changes_ = 0;
};

}  // namespace stereod::v4l2
