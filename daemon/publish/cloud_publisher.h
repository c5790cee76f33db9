// The points of a frame, on request.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/calibration.h"
#include "daemon/lcm/message_bus.h"
#include "daemon/publish/output_frame.h"
#include "daemon/publish/published_pixels.h"

namespace stereod {

/// Publishes PREFIX_CLOUD, a pointcloud_t, when a frame is complete: a point for every `step`-th pixel in
/// both directions of the region that is published, if its depth was measured. One thread's, the frame
/// publisher's; allocates nothing after its construction.
class CloudPublisher {
 public:
  CloudPublisher(MessageBus& bus, const std::string& prefix, const Calibration& calibration,
                 const MatcherOptions& matcher, const PublishedPixels& pixels, int step);

  /// A row of the rectified image, in any order, each once.
  void add_row(int y, const std::int16_t* disparity) noexcept;
  /// Every row was added: sends the points. False if the network refused them.
  bool finish(const FrameTiming& timing) noexcept;

  /// Bytes of the message that finish() would send.
  std::size_t bytes() const;

 private:
  MessageBus& bus_;
  const std::string channel_;
  const PublishedPixels pixels_;
  const int step_;
  std::vector<float> depth_m_;  // of each disparity; 0: too far for a point
  std::vector<float> across_;   // x / z of each column
  const double fy_, cy_;
  std::int32_t points_ = 0;
  std::vector<std::uint8_t>
      bytes_;            // the message as LCM encodes it, written here so that nothing is allocated
  std::size_t end_ = 0;  // of the points in it
};

}  // namespace stereod
