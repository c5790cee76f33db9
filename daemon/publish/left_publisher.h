// SPDX-License-Identifier: BSD-3-Clause
// The output PREFIX_LEFT: the rectified left image.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/base/image.h"
#include "daemon/config/config.h"
#include "daemon/imagefile/jpeg_encoder.h"
#include "daemon/lcm/message_bus.h"
#include "daemon/lcm/message_encoder.h"
#include "daemon/publish/image_publisher.h"
#include "stereod/image_t.hpp"

namespace stereod {

/// Publishes rectified left images at a limited rate. The workers copy their rows into the image only if one
/// is due. A JPEG of 640×480 pixels fits in one datagram; a gray image takes several, and a lost one loses
/// the image.
class LeftPublisher {
 public:
  /// @p size is the size of the rectified image [px].
  LeftPublisher(MessageBus& bus, const std::string& prefix, const LeftImageConfig& config, Size size);

  /// Returns the image to fill with the rectified rows of the present frame; null if none is due. Allocates
  /// nothing and does not wait.
  GrayImage* claim() noexcept { return publisher_.claim() ? &image_ : nullptr; }
  /// Sends the claimed image. @p utime is its frame's.
  void submit(std::int64_t utime) noexcept;
  void stop() noexcept { publisher_.stop(); }

  /// Returns how many messages the network refused, or the encoder failed on, since construction.
  std::int64_t refused() const noexcept { return publisher_.refused(); }

 private:
  bool send() noexcept;

  MessageBus& bus_;
  const std::string channel_;
  GrayImage image_;
  std::optional<JpegEncoder> jpeg_;
  image_t message_{};
  MessageEncoder encoder_;
  ImagePublisher publisher_;
};

}  // namespace stereod
