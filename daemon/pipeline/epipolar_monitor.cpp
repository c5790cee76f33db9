#include "daemon/pipeline/epipolar_monitor.h"

#include <algorithm>
#include <ctime>
#include <span>
#include <vector>

#include "daemon/base/clocks.h"

namespace stereod {
namespace {

// Patches are missing where less than one in so many of the usual ones is found.
constexpr double kMissing = 3;

std::int64_t thread_cpu_ns() noexcept {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

}  // namespace

EpipolarMonitor::EpipolarMonitor(Size image, int min_disparity, int disparities)
    : image_(image), probe_(image, min_disparity, disparities) {}

// A quarter is put by, as long as there is less than what kSaved such frames earn.
void EpipolarMonitor::earn(double ns) noexcept {
  constexpr double kSaved = 400;
  const double put_by = std::clamp(kSaved * ns - saved_ns_, 0.0, ns / 4);
  saved_ns_ += put_by;
  purse_ns_ = std::min(purse_ns_ + ns - put_by, kSaved * ns);
}

bool EpipolarMonitor::may_spend(EpipolarProbe::Reach reach) const noexcept {
  return purse_ns_ > 0 || (reach == EpipolarProbe::Reach::kFar && purse_ns_ + saved_ns_ > 0);
}

void EpipolarMonitor::spend(double ns, EpipolarProbe::Reach reach) noexcept {
  purse_ns_ -= ns;
  if (reach == EpipolarProbe::Reach::kFar && purse_ns_ < 0) {
    const double taken = std::min(saved_ns_, -purse_ns_);
    saved_ns_ -= taken, purse_ns_ += taken;
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
  found_lately_ += (found - found_lately_) / 24;
  found_usually_ += (found - found_usually_) / 240;
  if (found_lately_ < found_usually_ / kMissing) search_far();
}

void EpipolarMonitor::frame_matched(const ProbedFrame& left, const ProbedFrame& right,
                                    std::int64_t match_ns) noexcept {
  const double earned = kShare * static_cast<double>(match_ns);
  earn(earned);
  EpipolarProbe::Reach reach;
  {
    const std::lock_guard lock(mutex_);
    matched_ns_ += match_ns;
    reach = reach_;
  }
  if (!may_spend(reach)) return;
  std::array<EpipolarMatch, EpipolarProbe::kPatches> matches;
  const std::int64_t begin = thread_cpu_ns();
  const EpipolarProbe::Result result = probe_.probe(left, right, reach, matches);
  const std::int64_t spent = thread_cpu_ns() - begin;
  spend(static_cast<double>(spent), reach);
  // What the machine took from a thread meanwhile is not to be paid for with minutes of blindness.
  constexpr double kMaxDebt = 200;  // frames
  purse_ns_ = std::max(purse_ns_, -kMaxDebt * earned);

  const std::int64_t now = monotonic_ns();
  const std::lock_guard lock(mutex_);
  spent_ns_ += spent;
  // What was found with another reach than the present one belongs to neither.
  for (int i = 0; i < result.found && reach == reach_; ++i)
    remember({now, true, matches[static_cast<std::size_t>(i)]});
  for (int i = 0; i < result.absent && reach == reach_; ++i) remember({now, false, {}});
}

EpipolarStats EpipolarMonitor::stats() {
  std::vector<Point> newest;
  newest.reserve(kPoints);        // not while the matching thread may wait
  std::size_t of_far_search = 0;  // of the newest
  EpipolarStats stats;
  {
    const std::lock_guard lock(mutex_);
    for (std::size_t back = 1; back <= std::min(count_, kPoints); ++back) {
      newest.push_back(points_[(count_ - back) % kPoints]);
    }
    if (reach_ == EpipolarProbe::Reach::kFar) of_far_search = count_ - far_since_;
    if (matched_ns_ > 0) stats.cost_share = static_cast<double>(spent_ns_) / static_cast<double>(matched_ns_);
  }
  const std::int64_t now = monotonic_ns();
  std::vector<EpipolarMatch> found;
  std::size_t found_by_far_search = 0;
  for (const Point& point : newest) {
    const double age_s = static_cast<double>(now - point.at_ns) * 1e-9;
    const bool enough = found.size() >= kEnough;
    if (age_s > kMaxWindow_s || (age_s > kWindow_s && (enough || stats.searched >= kMany))) break;
    const bool hardly_any = stats.searched >= kManyFar && 50 * found.size() < stats.searched;
    if (of_far_search > 0 && stats.searched >= of_far_search && (enough || hardly_any)) break;
    ++stats.searched;
    if (!point.found) continue;
    found.push_back(point.match);
    if (stats.searched <= of_far_search) ++found_by_far_search;
  }
  if (stats.searched > 0) {
    stats.found_share = static_cast<double>(found.size()) / static_cast<double>(stats.searched);
  }
  stats.epipolar_error = epipolar_error(found, image_);
  const bool far_search_suffices = stats.epipolar_error && found_by_far_search == found.size();
  if (!far_search_suffices) {
    constexpr std::size_t kNewest = 16;
    const auto clear = clear_misalignment(std::span(found).first(std::min(found_by_far_search, kNewest)));
    if (clear) stats.epipolar_error = clear;
  }

  constexpr double kTogether_px = 1;  // of a part: from there on, rows may lie beyond what a near search sees
  const std::lock_guard lock(mutex_);
  bool together = stats.epipolar_error && stats.epipolar_error->worst_px < kTogether_px;
  // Where the true rows are out of reach, what little is found is found by chance: it can say that rows are
  // apart, but not that they are not.
  if (together && stats.found_share < found_together_ / kMissing) {
    stats.epipolar_error.reset();
    together = false;
  }
  constexpr double kSlowly = 0.05;  // a knock takes the window's few seconds to show
  if (together) {
    found_together_ += (stats.found_share - found_together_) * (found_together_ > 0 ? kSlowly : 1);
  }
  stats.usual_share = found_together_;
  if (reach_ == EpipolarProbe::Reach::kNear) {
    if (stats.epipolar_error && !together) search_far();
  } else if (together && found_by_far_search >= kEnough / 2) {
    reach_ = EpipolarProbe::Reach::kNear;
    found_lately_ = found_usually_ = stats.found_share;
  }
  return stats;
}

}  // namespace stereod
