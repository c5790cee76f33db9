// SPDX-License-Identifier: BSD-3-Clause
// From disparities to the distance of the nearest obstacle in each direction.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"

namespace stereod {

/// The ground relative to the left camera: a plane without roll.
struct GroundPlane {
  double height_m = 0.2;  ///< [m, > 0] of the camera above the ground
  double pitch_rad = 0;   ///< [rad, ±0.8] of the optical axis, positive downward
  friend bool operator==(const GroundPlane&, const GroundPlane&) = default;
};

/// The rectified camera and its disparities.
struct ScanGeometry {
  Size size;
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< px
  double baseline_m = 0;
  double disparity_offset = 0;  ///< px, see disparity_offset_px()
  int units_per_pixel = 1;      ///< a power of two
  int min_disparity = 0;        ///< px
  int disparities = 1;          ///< px
};

struct ScanOptions {
  /// [m, > 0] Anything up to this height above the ground can be driven over.
  double min_obstacle_height_m = 0.06;
  /// [m, > min_obstacle_height_m] Anything above this height can be driven under.
  double max_obstacle_height_m = 1.0;
  double max_range_m = 3;  ///< [m, > 0] obstacles farther away are ignored
  int rays = 80;           ///< [1…1024] directions
  int min_support = 60;    ///< [px, ≥ 1] of an obstacle within one direction and one pixel of disparity
  double stop_distance_m = 0.5;  ///< [m] 0: never stop
  double stop_width_m = 0.4;     ///< [m, > 0] of the way ahead that must be free
};

/// Distances over the ground from the left camera, one a direction, from right to left and evenly spaced in
/// angle: direction i is first_rad + i · step_rad, 0 straight ahead, positive to the left.
struct ScanResult {
  std::vector<float> range_m;  ///< max_range_m: no obstacle; 0: too few disparities in that direction
  std::vector<float> support;  ///< [px] of the obstacle; 0: no obstacle
  float first_rad = 0, step_rad = 0;
  /// Distance of the nearest obstacle along the way ahead; max_range_m: no obstacle; 0: too few disparities.
  float nearest_m = 0;
  /// The nearest obstacle is nearer than stop_distance_m, or over a quarter of the directions ahead have
  /// range 0.
  bool stop = false;
};

/// Finds obstacles in the rows of a frame, which may come in any order, each once. A pixel belongs to an
/// obstacle if its height above the ground is between min_obstacle_height_m and max_obstacle_height_m and its
/// disparity exceeds that of the ground by more than one pixel, so that noise of the floor is no obstacle.
/// Both are one pair of disparity thresholds a row (v-disparity: Labayrade, Aubert and Tarel, 2002). The
/// pixels of a direction are counted by disparity; the highest disparity with enough of them is the obstacle
/// (as the columns of Badino's stixels, 2009). Reads every fourth row and every second column, which suffices
/// for thin poles. Allocates nothing after construction.
class ObstacleScan {
 public:
  /// Allocates memory for disparity rows of @p camera, seen over @p ground.
  ObstacleScan(const ScanOptions& options, const ScanGeometry& camera, const GroundPlane& ground);

  /// Sets the ground for the rows added from now on.
  void set_ground(const GroundPlane& ground) noexcept;
  const GroundPlane& ground() const { return ground_; }

  /// Adds row @p y of a frame: camera.size.width disparities [units]; negative ones are ignored.
  void add_row(int y, const std::int16_t* disparity) noexcept;

  /// Returns the scan of the rows added since the last finish(). Valid until the next finish().
  const ScanResult& finish() noexcept;

 private:
  static constexpr int kRowStep = 4, kColumnStep = 2;

  // Pixels of a column group with one whole-pixel disparity: their number, and the sums of their units and
  // rows.
  using Bin [[gnu::vector_size(16)]] = std::int32_t;
  enum { kCount, kSumUnits, kSumY };

  struct Obstacle {
    double disparity_px, y;
    int pixels;
  };

  bool nearest_obstacle(int group, Obstacle& obstacle) noexcept;
  void enter(int group, const Obstacle& obstacle) noexcept;
  void look_ahead() noexcept;
  double bearing(double x, double y) const noexcept;
  int ray_at(double bearing_rad) const noexcept;

  const ScanOptions options_;
  const ScanGeometry camera_;
  GroundPlane ground_;
  double sin_pitch_ = 0, cos_pitch_ = 1;
  int units_shift_, bins_per_group_;
  std::vector<std::int16_t> above_,
      below_;                            // thresholds of each row: a pixel counts if above < units ≤ below
  std::vector<std::int32_t> first_bin_;  // of each column's group
  std::vector<ColumnRange> group_columns_;
  std::vector<std::int16_t> seen_;  // pixels with a disparity, by column
  std::vector<Bin> bins_;
  int rows_ = 0;  // added
  ScanResult result_;
};

}  // namespace stereod
