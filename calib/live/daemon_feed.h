// The running daemon's raw images.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "calib/live/frame_feed.h"
#include "daemon/lcm/receiver.h"

namespace stereod {

/// Takes PREFIX_LEFT_RAW and PREFIX_RIGHT_RAW, which the daemon publishes with `lcm.raw_images: true`, and
/// pairs them by time. Messages that are no gray image are passed over.
class DaemonFeed final : public FrameFeed {
 public:
  /// Throws BusError where LCM cannot be received.
  DaemonFeed(const std::string& lcm_url, const std::string& prefix);

  std::optional<ImagePair> next(std::chrono::milliseconds timeout) override;
  bool finished() const override { return false; }

 private:
  void take(Side side, std::span<const std::byte> message);

  LcmReceiver receiver_;
  Pairing<GrayImage> pairing_;
  std::uint64_t taken_ = 0;
};

}  // namespace stereod
