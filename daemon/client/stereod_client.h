// SPDX-License-Identifier: BSD-3-Clause
// libstereod-client: receives what stereod publishes. C++17. This header includes all others of the library.
//
//   stereod::StereoClient client(stereod::StereoClient::Options{});
//   client.on_frame([](stereod::StereoFrame&& frame) { use(frame.depth_m(320, 240)); });
//   while (true) client.handle(100);
//
// The library trusts nothing that comes over the network: a message that is malformed or contradicts itself is counted as
// ignored.
//
// The headers include each other by their bare names, so that the same files work in the source tree and installed as
// <stereod/…>.
#pragma once

#include <lcm/lcm.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "camera_geometry.h"
#include "frame_assembler.h"
#include "message_validation.h"
#include "reception_counts.h"
#include "row_block.h"
#include "stereo_frame.h"
#include "stereod/camera_info_t.hpp"
#include "wire_layout.h"

namespace stereod {

/// Subscribes to one daemon. Not thread-safe: the thread that calls handle() runs all handlers.
class StereoClient {
 public:
  struct Options {
    std::string url;                ///< empty: LCM_DEFAULT_URL of the environment, else LCM's default
    std::string prefix = "STEREO";  ///< of the channels
    /// [bytes], unless the URL has recv_buf_size; at most net.core.rmem_max of the kernel.
    int receive_buffer = 4 << 20;
    int queue_messages = 1000;  ///< messages that wait for a slow program; LCM drops more
    bool latest_only = true;    ///< handle() reads all waiting messages and hands over only the newest frame
  };

  /// Opens LCM and subscribes. Throws std::runtime_error.
  explicit StereoClient(const Options& options);
  /// Subscribes with the LCM instance of the program, which must outlive the client and which the program handles itself.
  /// Frames are handed over within lcm_handle(). LCM is C: an exception of a handler terminates the program.
  StereoClient(lcm_t* lcm, const std::string& prefix);
  ~StereoClient();
  StereoClient(const StereoClient&) = delete;
  StereoClient& operator=(const StereoClient&) = delete;

  /// Sets the handler of frames, complete or as far as they arrived.
  void on_frame(std::function<void(StereoFrame&&)> handler) { on_frame_ = std::move(handler); }
  /// Sets the handler of rows in the order of their arrival, for the lowest latency.
  void on_rows(std::function<void(const RowBlock&)> handler) { on_rows_ = std::move(handler); }
  /// Sets the handler of camera_info_t: about once a second, calibrated or not.
  void on_camera_info(std::function<void(const camera_info_t&)> handler) {
    on_camera_info_ = std::move(handler);
  }

  /// Blocks for up to @p timeout_ms [ms] until a message arrives, then handles all waiting messages. Returns false if none
  /// arrived. Throws what a handler throws, and std::runtime_error at the end of a log file.
  bool handle(int timeout_ms);

  /// Returns a descriptor for poll(): readable when handle() has work.
  int file_descriptor() const;

  const ReceptionCounts& counts() const { return assembler_.counts(); }
  std::int64_t frames_skipped() const { return frames_skipped_; }  ///< by latest_only
  const std::optional<CameraGeometry>& camera() const { return camera_; }

  /// Handle the bytes of one message that did not come from LCM's network.
  void take_rows(const void* bytes, std::size_t size);
  void take_frame(const void* bytes, std::size_t size);
  void take_camera_info(const void* bytes, std::size_t size);

  /// Returns a client without a subscription, for take_rows(), take_frame() and take_camera_info().
  static std::unique_ptr<StereoClient> unconnected();

 private:
  using Receiver = void (StereoClient::*)(const void*, std::size_t);
  struct Subscription;

  StereoClient();
  void subscribe(const std::string& prefix, int queue_messages);
  void hand_over(StereoFrame&& frame);
  static void on_message(const lcm_recv_buf_t* message, const char* channel, void* subscription);

  struct LcmCloser {
    void operator()(lcm_t* lcm) const noexcept;
  };
  std::unique_ptr<lcm_t, LcmCloser> owned_;
  lcm_t* lcm_ = nullptr;
  std::vector<std::unique_ptr<Subscription>> subscriptions_;
  std::exception_ptr error_;  // of a handler, until handle() rethrows it
  FrameAssembler assembler_;
  disparity_rows_t rows_{};  // a member, to reuse its memory
  std::optional<CameraGeometry> camera_;
  std::optional<StereoFrame> waiting_;  // with latest_only
  bool latest_only_ = false;
  std::int64_t frames_skipped_ = 0;
  std::function<void(StereoFrame&&)> on_frame_;
  std::function<void(const RowBlock&)> on_rows_;
  std::function<void(const camera_info_t&)> on_camera_info_;
};

}  // namespace stereod
