// SPDX-License-Identifier: BSD-3-Clause
// The output PREFIX_CLOUD: the points of a frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/calibration.h"
#include "core/match/options.h"
#include "daemon/lcm/message_bus.h"
#include "daemon/publish/published_pixels.h"
#include "daemon/publish/row_consumer.h"

namespace stereod {

/// Publishes a pointcloud_t at the end of each frame, after frame_t. It has a point for every pixel with
/// measured depth among every @p decimation-th column and row of the published region. Used by the publisher
/// thread only; allocates nothing after construction.
class CloudPublisher final : public RowConsumer {
 public:
  /// @p decimation [rows and columns of the rectified image, ≥ 1].
  CloudPublisher(MessageBus& bus, const std::string& prefix, const Calibration& calibration,
                 const MatcherOptions& matcher, const PublishedPixels& pixels, int decimation);

  void take_rows(const FinalRows& rows) noexcept override;
  void end_frame(const FrameTiming& timing) noexcept override;
  std::size_t bytes_at_end() const noexcept override;
  std::int64_t refused() const noexcept override { return refused_; }

 private:
  void add_row(int y, const std::int16_t* disparity) noexcept;

  MessageBus& bus_;
  const std::string channel_;
  const PublishedPixels pixels_;
  const int decimation_;
  std::vector<float> depth_m_;  // indexed by disparity; 0: too far for a point
  std::vector<float> x_per_z_;  // x / z of each column
  const double fy_, cy_;
  std::int32_t points_ = 0;
  std::vector<std::uint8_t> bytes_;  // the encoded message; the generated encoder would allocate
  std::size_t points_end_ = 0;       // where the points in bytes_ end
  std::int64_t refused_ = 0;
};

}  // namespace stereod
