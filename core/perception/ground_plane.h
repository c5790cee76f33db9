// SPDX-License-Identifier: BSD-3-Clause
// Estimates the ground plane from disparities.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/perception/obstacle_scan.h"

namespace stereod {

/// Fits the ground to the rows of a frame, which may come in any order. On a plane without roll, disparity
/// grows linearly from row to row (v-disparity: Labayrade, Aubert and Tarel, 2002). Takes the most frequent
/// disparity of every eighth row, finds the line through two of them that has the most support, and refines
/// it by least squares. Allocates nothing after construction.
class GroundFit {
 public:
  /// Allocates memory for disparity rows of @p camera.
  explicit GroundFit(const ScanGeometry& camera);

  /// Adds row @p y of a frame, see ObstacleScan::add_row().
  void add_row(int y, const std::int16_t* disparity) noexcept;

  /// Returns the ground that fits the rows added since the last finish(), or nullopt if fewer than kMinRows
  /// rows support one. A camera height outside 0.02…5 m or a pitch beyond ±0.8 rad is no ground.
  std::optional<GroundPlane> finish() noexcept;

  static constexpr int kMinRows = 6;

 private:
  static constexpr int kRowStep = 8;
  // The most frequent disparity of a row.
  struct Mode {
    double y, disparity_px;
    int pixels;
  };
  // disparity + disparity_offset = at_zero + slope · y
  struct Line {
    double slope = 0, at_zero = 0;
    int rows = 0, pixels = 0;  // of the modes within kTolerance_px
  };

  static bool supports(const Line& line, const Mode& mode) noexcept;
  Line best_line() const noexcept;
  Line refined(const Line& line) const noexcept;
  std::optional<GroundPlane> plane_of(const Line& line) const noexcept;

  const ScanGeometry camera_;
  std::vector<std::int32_t> counts_, sums_;  // of one row, by whole disparities
  std::vector<Mode> modes_;
};

}  // namespace stereod
