// Depth in millimeters, on request.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/calibration.h"
#include "daemon/lcm/message_bus.h"
#include "daemon/lcm/message_encoder.h"
#include "daemon/publish/output_frame.h"
#include "daemon/publish/published_pixels.h"
#include "stereod/depth_rows_t.hpp"

namespace stereod {

/// Publishes the depth of rows as PREFIX_DEPTH, for robots whose programs want no stereo camera's numbers.
/// One thread's, the frame publisher's; allocates nothing after its construction.
class DepthPublisher {
 public:
  static constexpr int kBytesPerValue = 2;
  static constexpr std::uint16_t kFarthest = 0xFFFF;  ///< so many mm or more

  /// `rows`: how many are sent at once at most.
  DepthPublisher(MessageBus& bus, const std::string& prefix, const Calibration& calibration,
                 const MatcherOptions& matcher, const PublishedPixels& pixels, int rows);

  /// Sends rows of what is published; `disparity` is the rectified image's. False if the network refused
  /// them.
  bool send_rows(const FrameTiming& timing, DisparityView disparity, RowRange rows) noexcept;

 private:
  MessageBus& bus_;
  const std::string channel_;
  std::vector<std::uint16_t> depth_mm_;  // of each disparity
  depth_rows_t message_{};
  MessageEncoder encoder_;
};

/// Meters of every fixed-point disparity that the matcher can find, from 0 on; infinite beyond the horizon.
std::vector<double> depths_of_disparities(const Calibration& calibration, const MatcherOptions& matcher);

}  // namespace stereod
