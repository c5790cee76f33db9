// The floor found in the disparities themselves.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/perception/obstacle_scan.h"

namespace stereod {

/// Takes a frame's rows in any order and fits the ground to them: on a plane without roll, disparity grows
/// linearly from row to row (v-disparity: Labayrade, Aubert and Tarel, 2002). Of each eighth row the most
/// frequent disparity is taken, and the line through two of them that most others agree with, refined by
/// least squares. Allocates nothing after its construction.
class GroundFit {
 public:
  explicit GroundFit(const ScanGeometry& camera);

  /// See ObstacleScan::add_row().
  void add_row(int y, const std::int16_t* disparity) noexcept;

  /// The ground that the rows since the last finish() show; nothing if fewer than kMinRows agree on one, or
  /// if the camera would be lower than 2 cm, higher than 5 m, or pitched by more than 0.8 rad.
  std::optional<GroundPlane> finish() noexcept;

  static constexpr int kMinRows = 6;

 private:
  static constexpr int kRowStep = 8;
  struct Mode {
    double y, disparity_px;
    int pixels;
  };
  struct Line {  // disparity with its offset = at_zero + slope · y
    double slope = 0, at_zero = 0;
    int rows = 0, pixels = 0;  // that agree with it
  };

  static bool agrees(const Line& line, const Mode& mode) noexcept;
  Line best_line() const noexcept;
  Line refined(const Line& line) const noexcept;
  std::optional<GroundPlane> plane_of(const Line& line) const noexcept;

  const ScanGeometry camera_;
  std::vector<std::int32_t> counts_, sums_;  // of one row, by whole pixels
  std::vector<Mode> modes_;
};

}  // namespace stereod
