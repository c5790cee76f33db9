// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pipeline/epipolar_monitor.h"

#include <algorithm>
#include <ctime>
#include <span>

#include "daemon/base/clocks.h"

namespace stereod {
namespace {

// Points are missing if fewer than 1 / kMissingFactor of the usual share is found.
constexpr double kMissingFactor = 3;

std::int64_t thread_cpu_ns() noexcept {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

}  // namespace

EpipolarMonitor::EpipolarMonitor(Size image, int min_disparity, int disparities)
    : image_(image), probe_(image, min_disparity, disparities) {}

// A quarter goes to the reserve until that holds the earnings of kMaxFrames such frames; so does the budget.
void EpipolarMonitor::earn_budget(double ns) noexcept {
  constexpr double kMaxFrames = 400;
  const double saved = std::clamp(kMaxFrames * ns - reserve_ns_, 0.0, ns / 4);
  reserve_ns_ += saved;
  budget_ns_ = std::min(budget_ns_ + ns - saved, kMaxFrames * ns);
}

bool EpipolarMonitor::has_budget(EpipolarProbe::Reach reach) const noexcept {
  return budget_ns_ > 0 || (reach == EpipolarProbe::Reach::kFar && budget_ns_ + reserve_ns_ > 0);
}

void EpipolarMonitor::spend_budget(double ns, EpipolarProbe::Reach reach) noexcept {
  budget_ns_ -= ns;
  if (reach == EpipolarProbe::Reach::kFar && budget_ns_ < 0) {
    const double taken = std::min(reserve_ns_, -budget_ns_);
    reserve_ns_ -= taken;
    budget_ns_ += taken;
  }
}

void EpipolarMonitor::search_far() noexcept {
  reach_ = EpipolarProbe::Reach::kFar;
  far_since_ = count_;
}

void EpipolarMonitor::remember(const Point& point) noexcept {
  points_[count_++ % kPoints] = point;
  if (reach_ == EpipolarProbe::Reach::kFar) return;
  const double found = point.found ? 1 : 0;
  recent_found_share_ += (found - recent_found_share_) / 24;
  average_found_share_ += (found - average_found_share_) / 240;
  if (recent_found_share_ < average_found_share_ / kMissingFactor) search_far();
}

void EpipolarMonitor::frame_matched(const ProbedFrame& left, const ProbedFrame& right,
                                    std::int64_t match_ns) noexcept {
  const double earned = kBudgetShare * static_cast<double>(match_ns);
  earn_budget(earned);
  EpipolarProbe::Reach reach;
  {
    const std::lock_guard lock(mutex_);
    matched_ns_ += match_ns;
    reach = reach_;
  }
  if (!has_budget(reach)) return;
  std::array<EpipolarMatch, EpipolarProbe::kPatches> matches;
  const std::int64_t begin = thread_cpu_ns();
  const EpipolarProbe::Result result = probe_.probe(left, right, reach, matches);
  const std::int64_t spent = thread_cpu_ns() - begin;
  spend_budget(static_cast<double>(spent), reach);
  // A probe that the system interrupts for long must not stop probing for minutes.
  constexpr double kMaxDebt = 200;  // frames
  budget_ns_ = std::max(budget_ns_, -kMaxDebt * earned);

  const std::int64_t now = monotonic_ns();
  const std::lock_guard lock(mutex_);
  spent_ns_ += spent;
  // Points found with another reach than the present one are dropped.
  for (int i = 0; i < result.found && reach == reach_; ++i) {
    remember({now, true, matches[static_cast<std::size_t>(i)]});
  }
  for (int i = 0; i < result.absent && reach == reach_; ++i) remember({now, false, {}});
}

EpipolarStats EpipolarMonitor::stats() {
  std::vector<Point> newest;
  newest.reserve(kPoints);  // before the lock, so that the matching thread does not wait for the allocation
  std::size_t far_points = 0;  // how many of the newest are of the present far search
  EpipolarStats stats;
  {
    const std::lock_guard lock(mutex_);
    for (std::size_t back = 1; back <= std::min(count_, kPoints); ++back) {
      newest.push_back(points_[(count_ - back) % kPoints]);
    }
    if (reach_ == EpipolarProbe::Reach::kFar) far_points = count_ - far_since_;
    if (matched_ns_ > 0) stats.cost_share = static_cast<double>(spent_ns_) / static_cast<double>(matched_ns_);
  }
  const Window window = select_window(newest, far_points);
  stats.searched = window.searched;
  if (window.searched > 0) {
    stats.found_share = static_cast<double>(window.found.size()) / static_cast<double>(window.searched);
  }
  stats.epipolar_error = measured_error(window);
  choose_reach(window, stats);
  return stats;
}

EpipolarMonitor::Window EpipolarMonitor::select_window(const std::vector<Point>& newest,
                                                       std::size_t far_points) const {
  const std::int64_t now = monotonic_ns();
  Window window;
  for (const Point& point : newest) {
    const double age_s = static_cast<double>(now - point.at_ns) * 1e-9;
    const bool enough = window.found.size() >= kEnoughFound;
    if (age_s > kMaxWindow_s || (age_s > kWindow_s && (enough || window.searched >= kEnoughSearched))) break;
    const bool hardly_any = window.searched >= kEnoughFar && 50 * window.found.size() < window.searched;
    if (far_points > 0 && window.searched >= far_points && (enough || hardly_any)) break;
    ++window.searched;
    if (!point.found) continue;
    window.found.push_back(point.match);
    if (window.searched <= far_points) ++window.found_far;
  }
  return window;
}

// While a far search has not replaced all older points, its newest few points may already show a clear
// misalignment.
std::optional<EpipolarError> EpipolarMonitor::measured_error(const Window& window) const {
  const auto error = epipolar_error(window.found, image_);
  const bool far_search_suffices = error && window.found_far == window.found.size();
  if (far_search_suffices) return error;
  constexpr std::size_t kNewest = 16;
  const auto clear = clear_misalignment(std::span(window.found).first(std::min(window.found_far, kNewest)));
  return clear ? clear : error;
}

void EpipolarMonitor::choose_reach(const Window& window, EpipolarStats& stats) noexcept {
  // Of the worst part of the image: above it, points may lie beyond the reach of the near search.
  constexpr double kAligned_px = 1;
  constexpr double kUpdateWeight = 0.05;  // small, because lost calibration takes some seconds to show
  const std::lock_guard lock(mutex_);
  bool aligned = stats.epipolar_error && stats.epipolar_error->worst_px < kAligned_px;
  // If the true rows are out of reach, the few points found are chance matches. They can show a misalignment
  // but not exclude one.
  if (aligned && stats.found_share < usual_found_share_ / kMissingFactor) {
    stats.epipolar_error.reset();
    aligned = false;
  }
  if (aligned) {
    usual_found_share_ +=
        (stats.found_share - usual_found_share_) * (usual_found_share_ > 0 ? kUpdateWeight : 1);
  }
  stats.usual_share = usual_found_share_;
  if (reach_ == EpipolarProbe::Reach::kNear) {
    if (stats.epipolar_error && !aligned) search_far();
  } else if (aligned && window.found_far >= kEnoughFound / 2) {
    reach_ = EpipolarProbe::Reach::kNear;
    recent_found_share_ = average_found_share_ = stats.found_share;
  }
}

}  // namespace stereod
