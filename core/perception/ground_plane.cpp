// SPDX-License-Identifier: BSD-3-Clause
#include "core/perception/ground_plane.h"

#include <algorithm>
#include <cmath>

namespace stereod {
namespace {

constexpr double kTolerance_px = 0.5;  // between a mode and the line
constexpr int kShare = 12;             // a mode has at least 1/kShare of the pixels of its row

}  // namespace

GroundFit::GroundFit(const ScanGeometry& camera)
    : camera_(camera),
      counts_(static_cast<std::size_t>(camera.min_disparity + camera.disparities) + 2),
      sums_(counts_.size()) {
  modes_.reserve(static_cast<std::size_t>(camera.size.height / kRowStep + 1));
}

void GroundFit::add_row(int y, const std::int16_t* disparity) noexcept {
  if (y % kRowStep != 0 || modes_.size() == modes_.capacity()) return;
  std::fill(counts_.begin(), counts_.end(), 0);
  std::fill(sums_.begin(), sums_.end(), 0);
  for (int x = 0; x < camera_.size.width; ++x) {
    if (disparity[x] < 0) continue;
    const auto bin = static_cast<std::size_t>(disparity[x] / camera_.units_per_pixel);
    if (bin >= counts_.size()) continue;
    ++counts_[bin];
    sums_[bin] += disparity[x];
  }
  // Two neighboring bins, so that a disparity between whole pixels is not split.
  std::size_t best = 0;
  for (std::size_t i = 1; i + 1 < counts_.size(); ++i) {
    if (counts_[i] + counts_[i + 1] > counts_[best] + counts_[best + 1]) best = i;
  }
  const int count = counts_[best] + counts_[best + 1];
  if (count * kShare < camera_.size.width) return;
  const double units = static_cast<double>(sums_[best] + sums_[best + 1]) / count;
  modes_.push_back(
      {static_cast<double>(y), units / camera_.units_per_pixel + camera_.disparity_offset, count});
}

std::optional<GroundPlane> GroundFit::finish() noexcept {
  const Line line = best_line();
  std::optional<GroundPlane> plane;
  if (line.rows >= kMinRows) plane = plane_of(refined(line));
  modes_.clear();
  return plane;
}

bool GroundFit::supports(const Line& line, const Mode& mode) noexcept {
  return std::abs(line.at_zero + line.slope * mode.y - mode.disparity_px) <= kTolerance_px;
}

// A wall is a line as well, but its plane is no possible ground.
GroundFit::Line GroundFit::best_line() const noexcept {
  Line best;
  for (const Mode& one : modes_) {
    for (const Mode& other : modes_) {
      if (other.y <= one.y) continue;
      Line line;
      line.slope = (other.disparity_px - one.disparity_px) / (other.y - one.y);
      line.at_zero = one.disparity_px - line.slope * one.y;
      if (!plane_of(line)) continue;
      for (const Mode& mode : modes_) {
        if (!supports(line, mode)) continue;
        ++line.rows;
        line.pixels += mode.pixels;
      }
      if (line.pixels > best.pixels) best = line;
    }
  }
  return best;
}

GroundFit::Line GroundFit::refined(const Line& line) const noexcept {
  double n = 0, y = 0, d = 0, yy = 0, yd = 0;
  for (const Mode& mode : modes_) {
    if (!supports(line, mode)) continue;
    n += 1;
    y += mode.y;
    d += mode.disparity_px;
    yy += mode.y * mode.y;
    yd += mode.y * mode.disparity_px;
  }
  const double slope = (n * yd - y * d) / (n * yy - y * y);
  return {slope, (d - slope * y) / n, line.rows, line.pixels};
}

// Solves d = f·B / h · ((y − cy) / fy · cos + sin) for h and the pitch.
std::optional<GroundPlane> GroundFit::plane_of(const Line& line) const noexcept {
  const double focal_baseline = camera_.fx * camera_.baseline_m;
  const double cos_by_h = line.slope * camera_.fy / focal_baseline;
  const double sin_by_h = (line.at_zero + line.slope * camera_.cy) / focal_baseline;
  const GroundPlane plane{1 / std::hypot(cos_by_h, sin_by_h), std::atan2(sin_by_h, cos_by_h)};
  const bool possible = plane.height_m > 0.02 && plane.height_m < 5 && std::abs(plane.pitch_rad) <= 0.8;
  return possible ? std::optional<GroundPlane>(plane) : std::nullopt;
}

}  // namespace stereod
