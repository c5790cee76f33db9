// SPDX-License-Identifier: BSD-3-Clause
// Holds the latest of everything that stereod publishes, for the page.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "daemon/client/stereod_client.h"
#include "stereod/image_t.hpp"
#include "stereod/planar_lidar_t.hpp"
#include "stereod/status_t.hpp"

namespace stereod::tools {

/// A frame and what was known when it arrived. Immutable once several threads can see it.
struct Snapshot {
  std::int64_t number = 0;  ///< from 1, +1 for each snapshot; independent of the frame number
  std::optional<StereoFrame> frame;
  std::optional<planar_lidar_t> scan;  ///< empty if the latest scan is more than 2 s from the frame
  std::optional<status_t> status;
  std::int64_t status_age_ms = 0;
  std::vector<std::uint8_t> left_jpeg;  ///< empty if the latest left image is more than 12 s from the frame
  std::int64_t left_utime = 0;          ///< frame of the left image
  ReceptionCounts counts;
};

/// Makes snapshots of the messages. One thread calls take(), any number of threads call wait_newer().
class LiveView {
 public:
  /// Makes a snapshot of the frame and what arrived before.
  void take(StereoFrame&& frame, const ReceptionCounts& counts);
  /// Keeps a scan. Ignores one that the daemon cannot have sent.
  void take(planar_lidar_t&& scan);
  /// Keeps a status. Makes a snapshot if no frame has arrived for 1 s, as without cameras.
  void take(status_t&& status);
  /// Keeps a left image in 8-bit gray or JPEG with sides of at most kMaxImageSide. Ignores others.
  void take(const image_t& left);

  /// Blocks until there is a snapshot with a number greater than @p after, but at most @p max_wait. Returns the newest
  /// snapshot; null if there is none.
  std::shared_ptr<const Snapshot> wait_newer(std::int64_t after, std::chrono::milliseconds max_wait) const;

 private:
  void publish_locked(std::optional<StereoFrame>&& frame);

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::shared_ptr<const Snapshot> newest_;
  std::int64_t number_ = 0;
  ReceptionCounts counts_;
  std::optional<planar_lidar_t> scan_;
  std::optional<status_t> status_;
  std::chrono::steady_clock::time_point status_arrival_, frame_arrival_;
  std::vector<std::uint8_t> left_jpeg_;
  std::int64_t left_utime_ = 0;
};

}  // namespace stereod::tools
