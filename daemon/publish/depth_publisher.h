// SPDX-License-Identifier: BSD-3-Clause
// The output PREFIX_DEPTH: depth in millimeters.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/calibration.h"
#include "core/match/options.h"
#include "daemon/lcm/message_bus.h"
#include "daemon/lcm/message_encoder.h"
#include "daemon/publish/published_pixels.h"
#include "daemon/publish/row_consumer.h"
#include "stereod/depth_rows_t.hpp"

namespace stereod {

/// Publishes the measured depth of each block of rows as depth_rows_t, for programs that do not want to
/// convert disparities. Used by the publisher thread only; allocates nothing after construction.
class DepthPublisher final : public RowConsumer {
 public:
  static constexpr int kBytesPerValue = 2;
  static constexpr std::uint16_t kFarthest = 0xFFFF;  ///< this depth or farther [mm]

  /// @p max_rows is the maximum number of published rows in a block.
  DepthPublisher(MessageBus& bus, const std::string& prefix, const Calibration& calibration,
                 const MatcherOptions& matcher, const PublishedPixels& pixels, int max_rows);

  void take_rows(const FinalRows& rows) noexcept override;
  std::size_t bytes_for_rows(int rows) const noexcept override;
  std::int64_t refused() const noexcept override { return refused_; }

 private:
  MessageBus& bus_;
  const std::string channel_;
  std::vector<std::uint16_t> depth_mm_;  // indexed by disparity
  depth_rows_t message_{};
  MessageEncoder encoder_;
  std::int64_t refused_ = 0;
};

/// Returns the depth [m] of every fixed-point disparity that the matcher can find, starting at 0; infinite at
/// and beyond the horizon.
std::vector<double> depths_of_disparities(const Calibration& calibration, const MatcherOptions& matcher);

}  // namespace stereod
