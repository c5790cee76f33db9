// SPDX-License-Identifier: BSD-3-Clause
#include "core/perception/obstacle_scan.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/base/simd_i16x8.h"
#include "core/geometry/depth.h"

namespace stereod {
namespace {

constexpr double kMargin_px = 1;   // between the disparities of an obstacle and of the ground
constexpr double kMinSeen = 0.05;  // share of the pixels of a direction; with less its range is 0

std::int16_t to_units(double px, int units_per_pixel) {
  constexpr double kMax = std::numeric_limits<std::int16_t>::max();
  return static_cast<std::int16_t>(std::clamp(std::floor(px * units_per_pixel), 0.0, kMax));
}

}  // namespace

ObstacleScan::ObstacleScan(const ScanOptions& options, const ScanGeometry& camera, const GroundPlane& ground)
    : options_(options),
      camera_(camera),
      units_shift_(std::countr_zero(static_cast<unsigned>(camera.units_per_pixel))),
      bins_per_group_(camera.min_disparity + camera.disparities + 1),
      above_(static_cast<std::size_t>(camera.size.height)),
      below_(static_cast<std::size_t>(camera.size.height)),
      first_bin_(static_cast<std::size_t>(camera.size.width)),
      group_columns_(static_cast<std::size_t>(options.rays)),
      seen_(static_cast<std::size_t>(camera.size.width)),
      bins_(static_cast<std::size_t>(options.rays) * static_cast<std::size_t>(bins_per_group_)) {
  const auto rays = static_cast<std::size_t>(options.rays);
  result_.range_m.resize(rays);
  result_.support.resize(rays);
  const double right = std::atan((camera.cx - camera.size.width) / camera.fx);
  const double left = std::atan(camera.cx / camera.fx);
  const double step = (left - right) / options.rays;
  result_.first_rad = static_cast<float>(right + step / 2);
  result_.step_rad = static_cast<float>(step);
  for (int x = 0; x < camera.size.width; ++x) {
    const double angle = std::atan((camera.cx - x - 0.5) / camera.fx);
    const int group = std::clamp(static_cast<int>((angle - right) / step), 0, options.rays - 1);
    first_bin_[static_cast<std::size_t>(x)] = group * bins_per_group_;
    ColumnRange& columns = group_columns_[static_cast<std::size_t>(group)];
    if (columns.count() == 0) columns.first = x;
    columns.end = x + 1;
  }
  set_ground(ground);
}

// With y' = (y − cy) / fy and Z the depth, a pixel is Z · (y' cos + sin) below the camera, so its height
// above the ground is h − f·B / d · (y' cos + sin): a height is a disparity.
void ObstacleScan::set_ground(const GroundPlane& ground) noexcept {
  ground_ = ground;
  sin_pitch_ = std::sin(ground.pitch_rad);
  cos_pitch_ = std::cos(ground.pitch_rad);
  const double focal_baseline = camera_.fx * camera_.baseline_m;
  const double h = ground.height_m;
  for (int y = 0; y < camera_.size.height; ++y) {
    const double down = (y - camera_.cy) / camera_.fy * cos_pitch_ + sin_pitch_;
    const double forward = cos_pitch_ - (y - camera_.cy) / camera_.fy * sin_pitch_;
    // Returns the disparity of a pixel of this row at that height. Higher disparities are higher above the
    // ground if the row looks down, and lower if it looks up.
    const auto at_height = [&](double height) { return focal_baseline * down / (h - height); };
    double above = focal_baseline * std::max(forward, 0.0) / options_.max_range_m;
    double below = std::numeric_limits<double>::max();
    if (down > 0) {
      above = std::max(above, at_height(0) + kMargin_px);
      if (options_.min_obstacle_height_m < h)
        above = std::max(above, at_height(options_.min_obstacle_height_m));
      if (options_.min_obstacle_height_m >= h) below = 0;
      if (options_.max_obstacle_height_m < h) below = at_height(options_.max_obstacle_height_m);
    } else if (options_.max_obstacle_height_m > h) {
      above = std::max(above, at_height(options_.max_obstacle_height_m));
      if (options_.min_obstacle_height_m > h) below = at_height(options_.min_obstacle_height_m);
    } else {
      below = 0;  // the row sees only what is above the camera and can be driven under
    }
    const auto row = static_cast<std::size_t>(y);
    const double offset = camera_.disparity_offset;
    above_[row] = to_units(above - offset, camera_.units_per_pixel);
    below_[row] = below > 1e6 ? std::numeric_limits<std::int16_t>::max()
                              : to_units(below - offset, camera_.units_per_pixel);
  }
}

void ObstacleScan::add_row(int y, const std::int16_t* disparity) noexcept {
  if (y % kRowStep != 0) return;
  // Local copies, because for the compiler a store may alias the members.
  const int width = camera_.size.width, bins_per_group = bins_per_group_, shift = units_shift_;
  const std::int16_t above = above_[static_cast<std::size_t>(y)], below = below_[static_cast<std::size_t>(y)];
  const std::int32_t* const first_bin = first_bin_.data();
  std::int16_t* const seen = seen_.data();
  Bin* const bins = bins_.data();
  const auto count_from = [=](int x, int end) {
    for (; x < end; x += kColumnStep) {
      const int value = disparity[x], bin = value >> shift;
      if (value > above && value <= below && bin < bins_per_group)
        bins[first_bin[x] + bin] += Bin{1, value, y};
    }
  };
  int x = 0;
  for (; x + kI16Lanes <= width; x += kI16Lanes) {
    const I16x8 values = load_i16x8(disparity + x);
    store_i16x8(seen + x, load_i16x8(seen + x) - (values >= I16x8{}));
    if (any_of((values > above) & (values <= below))) count_from(x, x + kI16Lanes);  // mostly no pixel counts
  }
  count_from(x, width);
  for (; x < width; ++x) seen[x] = static_cast<std::int16_t>(seen[x] + (disparity[x] >= 0 ? 1 : 0));
  ++rows_;
}

const ScanResult& ObstacleScan::finish() noexcept {
  std::fill(result_.support.begin(), result_.support.end(), 0.0F);
  std::fill(result_.range_m.begin(), result_.range_m.end(), static_cast<float>(options_.max_range_m));
  for (int group = 0; group < options_.rays; ++group) {
    const ColumnRange columns = group_columns_[static_cast<std::size_t>(group)];
    int seen = 0;
    for (int x = columns.first; x < columns.end; ++x) seen += seen_[static_cast<std::size_t>(x)];
    if (seen <= kMinSeen * columns.count() * rows_) result_.range_m[static_cast<std::size_t>(group)] = 0;
  }
  for (int group = 0; group < options_.rays; ++group) {
    Obstacle obstacle{};
    if (nearest_obstacle(group, obstacle)) enter(group, obstacle);
  }
  look_ahead();
  std::fill(bins_.begin(), bins_.end(), Bin());
  std::fill(seen_.begin(), seen_.end(), std::int16_t{0});
  rows_ = 0;
  return result_;
}

bool ObstacleScan::nearest_obstacle(int group, Obstacle& obstacle) noexcept {
  const Bin* bins = bins_.data() + static_cast<std::ptrdiff_t>(group) * bins_per_group_;
  constexpr int kPixels = kRowStep * kColumnStep;  // of the image for each pixel read
  const int needed = (options_.min_support + kPixels - 1) / kPixels;
  for (int bin = bins_per_group_ - 1; bin > 0; --bin) {
    const Bin both = bins[bin] + bins[bin - 1];
    const int count = both[kCount];
    if (count < needed) continue;
    obstacle.disparity_px = static_cast<double>(both[kSumUnits]) / count / camera_.units_per_pixel;
    obstacle.y = static_cast<double>(both[kSumY]) / count;
    obstacle.pixels = count * kPixels;
    return true;
  }
  return false;
}

// Seen from above, the columns of a camera that looks down form a wider fan than its field of view.
double ObstacleScan::bearing(double x, double y) const noexcept {
  const double forward = cos_pitch_ - (y - camera_.cy) / camera_.fy * sin_pitch_;
  return std::atan2((camera_.cx - x) / camera_.fx, forward);
}

int ObstacleScan::ray_at(double bearing_rad) const noexcept {
  const double ray =
      (bearing_rad - static_cast<double>(result_.first_rad)) / static_cast<double>(result_.step_rad);
  return static_cast<int>(std::floor(ray + 0.5));
}

void ObstacleScan::enter(int group, const Obstacle& obstacle) noexcept {
  const ColumnRange columns = group_columns_[static_cast<std::size_t>(group)];
  const double z = depth_m(camera_.fx, camera_.baseline_m, camera_.disparity_offset, obstacle.disparity_px);
  const double forward = z * (cos_pitch_ - (obstacle.y - camera_.cy) / camera_.fy * sin_pitch_);
  const double across = z * ((columns.first + columns.end) / 2.0 - camera_.cx) / camera_.fx;
  const auto range = static_cast<float>(std::hypot(forward, across));
  if (!(range < static_cast<float>(options_.max_range_m))) return;
  // Half a pixel inward, so that a border between two directions belongs to one of them.
  const int first = std::max(ray_at(bearing(columns.end - 0.5, obstacle.y)), 0);
  const int last = std::min(ray_at(bearing(columns.first + 0.5, obstacle.y)), options_.rays - 1);
  for (int ray = first; ray <= last; ++ray) {
    const auto i = static_cast<std::size_t>(ray);
    if (result_.support[i] > 0 && result_.range_m[i] <= range) continue;
    result_.range_m[i] = range;
    result_.support[i] = static_cast<float>(obstacle.pixels);
  }
}

// Finds the nearest obstacle within half of stop_width_m to either side, and whether enough of the way ahead
// is seen.
void ObstacleScan::look_ahead() noexcept {
  double nearest = options_.max_range_m;
  int directions = 0, blind = 0;  // ahead
  for (std::size_t i = 0; i < result_.range_m.size(); ++i) {
    const double angle = static_cast<double>(result_.first_rad) +
                         static_cast<double>(i) * static_cast<double>(result_.step_rad);
    const double range = static_cast<double>(result_.range_m[i]);
    const bool ahead = std::abs(options_.stop_distance_m * std::sin(angle)) <= options_.stop_width_m / 2;
    directions += ahead ? 1 : 0;
    blind += ahead && !(range > 0) ? 1 : 0;
    if (result_.support[i] == 0) continue;
    if (std::abs(range * std::sin(angle)) <= options_.stop_width_m / 2) {
      nearest = std::min(nearest, range * std::cos(angle));
    }
  }
  // Things nearer than the maximum disparity or without texture leave holes.
  const bool too_little = 4 * blind > directions || directions == 0;
  const bool near = nearest < options_.stop_distance_m;
  result_.nearest_m = too_little && !near ? 0 : static_cast<float>(nearest);
  result_.stop = options_.stop_distance_m > 0 && (too_little || near);
}

}  // namespace stereod
