// The latest of everything that stereod publishes, for the page to show.
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

namespace stereod {

/// A frame and what was known when it came. Never changed once it can be seen by several threads.
struct Snapshot {
  std::int64_t number = 0;  ///< counts up from 1 with everything new; not the frame's
  std::optional<StereoFrame> frame;
  std::optional<planar_lidar_t> scan;  ///< and left image: none if the newest is too far from the frame
  std::optional<status_t> status;
  std::int64_t status_age_ms = 0;
  std::vector<std::uint8_t> left_jpeg;  ///< the newest left image; empty: none
  std::int64_t left_utime = 0;          ///< of which frame it is
  ReceptionCounts counts;
};

/// One thread puts messages in, any number take moments out.
class LiveView {
 public:
  /// What arrives; a frame makes a new moment of all that was there before it.
  void take(StereoFrame&& frame, const ReceptionCounts& counts);
  /// One that the daemon cannot have made is passed over.
  void take(planar_lidar_t&& scan);
  /// Without frames (no cameras, say) a status makes a moment, too.
  void take(status_t&& status);
  /// Only 8-bit gray and JPEG of a sane size; anything else is passed over.
  void take(const image_t& left);

  /// The newest moment once its number is greater than `after`, or after `patience` whatever there is; null
  /// if nothing ever came.
  std::shared_ptr<const Snapshot> wait_newer(std::int64_t after, std::chrono::milliseconds patience) const;

 private:
  void publish_locked(std::optional<StereoFrame>&& frame);

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::shared_ptr<const Snapshot> newest_;
  std::int64_t number_ = 0;
  ReceptionCounts counts_;
  std::optional<planar_lidar_t> scan_;
  std::optional<status_t> status_;
  std::chrono::steady_clock::time_point status_came_, frame_came_;
  std::vector<std::uint8_t> left_jpeg_;
  std::int64_t left_utime_ = 0;
};

/// A moment as the page fetches it: the length of the JSON (4 bytes, little-endian), the JSON, the
/// disparities of every `step`-th row and column (packed as snapshot_codec.cpp says, compressed by zlib), the
/// left image as JPEG. The JSON says how long the last two are.
std::string encoded_moment(const Snapshot& snapshot, int step);

}  // namespace stereod
