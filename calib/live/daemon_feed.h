// SPDX-License-Identifier: BSD-3-Clause
// Image pairs from a running daemon.
#pragma once

#include <cstdint>
#include <string>

#include "calib/live/frame_feed.h"
#include "calib/live/raw_image_pairing.h"
#include "daemon/lcm/receiver.h"

namespace stereod::calib {

/// Receives PREFIX_LEFT_RAW and PREFIX_RIGHT_RAW, which a daemon with `lcm.raw_images: true` publishes.
class DaemonFeed final : public FrameFeed {
 public:
  /// @throws BusError if LCM cannot be received from @p lcm_url.
  DaemonFeed(const std::string& lcm_url, const std::string& prefix);

  /// Reads all messages that wait, and returns the newest pair.
  std::optional<ImagePair> next(std::chrono::milliseconds timeout) override;
  bool finished() const override { return false; }

 private:
  void read_waiting_messages();

  LcmReceiver receiver_;
  RawImagePairing pairing_;
  std::uint64_t taken_ = 0;
};

}  // namespace stereod::calib
