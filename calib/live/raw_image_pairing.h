// SPDX-License-Identifier: BSD-3-Clause
// Pairs the raw images that a daemon publishes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>

#include "calib/base/pair_input.h"
#include "core/sync/pairing.h"

namespace stereod::calib {

/// Decodes image_t messages and pairs them by time, newest first. Like the daemon's PairQueue, the tolerance is half
/// the frame time of the slower side. The frame time of a side is the shortest interval between its recent
/// messages, because lost messages only make intervals longer.
class RawImagePairing {
 public:
  /// Adds one message. Returns false and ignores it unless it is a complete 8-bit gray image of at most
  /// kMaxImageSide × kMaxImageSide pixels. Memory is allocated only after these checks.
  bool add(Side side, std::span<const std::byte> message);

  /// Returns the newest pair of two images of the same size, without a name; nothing if no pair is ready.
  std::optional<ImagePair> take();

 private:
  /// The recent timestamps of one side.
  class FrameTime {
   public:
    void add(std::int64_t utime);
    /// Returns the frame time [ns]; 0 while it is unknown.
    std::int64_t frame_ns() const;

   private:
    std::optional<std::int64_t> last_utime_;
    std::deque<std::int64_t> intervals_us_;
  };

  // Until the frame time is known.
  static constexpr std::int64_t kInitialTolerance_ns = 50'000'000;

  Pairing<GrayImage> pairing_{kInitialTolerance_ns};
  FrameTime left_, right_;
};

}  // namespace stereod::calib
