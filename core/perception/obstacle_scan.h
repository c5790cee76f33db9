// From disparity to "how far is the nearest thing in each direction".
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.h"

namespace stereod {

/// The floor as the left camera sees it: a plane without roll.
struct GroundPlane {
  double height_m = 0.2;  ///< of the camera above it, > 0
  double pitch_rad = 0;   ///< how far the optical axis points down, within ±0.8
  friend bool operator==(const GroundPlane&, const GroundPlane&) = default;
};

/// What a scan needs to know of the rectified camera and the disparities it gives.
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
  double min_obstacle_height_m =
      0.06;  ///< what is no higher than this above the ground can be driven over, > 0
  double max_obstacle_height_m =
      1.0;                 ///< what begins above this can be driven under, > min_obstacle_height_m
  double max_range_m = 3;  ///< what is further away is not looked at, > 0
  int rays = 80;           ///< directions, 1…1024
  int min_support = 60;    ///< pixels of an obstacle within one direction and one pixel of disparity, ≥ 1
  double stop_distance_m = 0.5;  ///< 0: never stop
  double stop_width_m = 0.4;     ///< of the way ahead that has to be free, > 0
};

/// Distances over the ground from the left camera, direction by direction from the right to the left, evenly
/// spaced in angle: direction i is first_rad + i · step_rad, 0 straight ahead, to the left positive.
struct ScanResult {
  std::vector<float> range_m;  ///< max_range_m: nothing found; 0: too little seen in that direction to say
  std::vector<float> support;  ///< pixels of the obstacle; 0: no obstacle
  float first_rad = 0, step_rad = 0;
  /// Along the way ahead, of what stands in it; max_range_m if nothing does; 0 if too little was seen to say.
  float nearest_m = 0;
  bool stop = false;  ///< that is nearer than stop_distance_m, or a quarter of the way ahead was not seen
};

/// Takes a frame's rows in any order, once each. A pixel belongs to an obstacle if its height above the
/// ground is between min_obstacle_height_m and max_obstacle_height_m, and its disparity more than one pixel above that of the ground,
/// so that the floor's own noise makes none; both are one pair of thresholds a row (v-disparity: Labayrade,
/// Aubert and Tarel, 2002). The pixels of a direction are counted by disparity, and the nearest disparity
/// with enough of them is the obstacle (the column-wise counting of Badino's stixels, 2009). Of the
/// rows every fourth is looked at, of the columns, for the sake of poles, every second. Allocates nothing
/// after its construction.
class ObstacleScan {
 public:
  ObstacleScan(const ScanOptions& options, const ScanGeometry& camera, const GroundPlane& ground);

  /// The rows that come from now on are seen over this ground.
  void set_ground(const GroundPlane& ground) noexcept;
  const GroundPlane& ground() const { return ground_; }

  /// Row y of a frame: as many disparities as the image is wide, in units, negative where there is none.
  void add_row(int y, const std::int16_t* disparity) noexcept;

  /// What the rows since the last finish() show; valid until the next.
  const ScanResult& finish() noexcept;

 private:
  static constexpr int kRowStep = 4, kColumnStep = 2;

  // Pixels of a column group with one whole-pixel disparity: how many, and sums of their units and rows.
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
  std::vector<std::int16_t> above_, below_;  // of each row: a pixel counts if above < units ≤ below
  std::vector<std::int32_t> first_bin_;      // of each column's group
  std::vector<RowRange> group_columns_;
  std::vector<std::int16_t> seen_;  // pixels with a disparity in each column
  std::vector<Bin> bins_;
  int rows_ = 0;  // looked at
  ScanResult result_;
};

}  // namespace stereod
