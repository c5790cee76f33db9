// SPDX-License-Identifier: BSD-3-Clause
// The outputs PREFIX_LEFT_RAW and PREFIX_RIGHT_RAW: the images of the cameras.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/luma_view.h"
#include "daemon/lcm/message_bus.h"
#include "daemon/lcm/message_encoder.h"
#include "daemon/publish/image_publisher.h"
#include "stereod/image_t.hpp"

namespace stereod {

/// The luma of a camera image and its start of exposure.
struct RawImage {
  const LumaView& luma;
  std::int64_t utime;  ///< [µs since the Unix epoch]
};

/// Publishes both images of a pair at a limited rate. The matching thread only copies, and only if a pair is
/// due.
///
/// An image is larger than a datagram: on a network that loses 1 % of the fragments, a 640×480 image (200
/// Ethernet packets) arrives one time in eight. On the same machine, or with a large socket buffer, every
/// image arrives.
class RawPublisher {
 public:
  /// @p size is the size of the camera images [px].
  RawPublisher(MessageBus& bus, const std::string& prefix, double pairs_per_second, Size size);

  /// Copies the pair if one is due and the previous one is sent. The left utime equals that in the messages
  /// of its frame, so that a log shows what belongs together. Allocates nothing and does not wait.
  void offer(const RawImage& left, const RawImage& right) noexcept;
  void stop() noexcept { publisher_.stop(); }

  /// Returns how many messages the network refused since construction.
  std::int64_t refused() const noexcept { return publisher_.refused(); }

 private:
  MessageBus& bus_;
  const std::string left_channel_, right_channel_;
  image_t left_, right_;
  MessageEncoder encoder_;
  ImagePublisher publisher_;
};

}  // namespace stereod
