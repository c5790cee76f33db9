// The running daemon's raw pictures.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "calib/frame_feed.h"
#include "daemon/tools/tap/lcm_receiver.h"

namespace stereod {

/// Takes PREFIX_LEFT_RAW and PREFIX_RIGHT_RAW, which the daemon publishes with `lcm.raw_images: true`, and
/// pairs them by time. Messages that are no grey picture are passed over.
class DaemonFeed final : public FrameFeed {
 public:
  /// Throws BusError where LCM cannot be received.
  DaemonFeed(const std::string& lcm_url, const std::string& prefix);

  std::optional<PicturePair> next(std::chrono::milliseconds timeout) override;
  bool finished() const override { return false; }

 private:
  void take(Side side, std::span<const std::byte> message);

  LcmReceiver receiver_;
  Pairing<GreyImage> pairing_;
  std::uint64_t taken_ = 0;
};

}  // namespace stereod
