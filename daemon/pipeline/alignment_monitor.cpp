#include "daemon/pipeline/alignment_monitor.h"

#include <algorithm>
#include <ctime>
#include <vector>

#include "daemon/pipeline/clocks.h"

namespace stereod {
namespace {

std::int64_t thread_cpu_ns() noexcept {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

}  // namespace

AlignmentMonitor::AlignmentMonitor(Size image, int min_disparity, int disparities)
    : image_(image), probe_(image, min_disparity, disparities) {}

void AlignmentMonitor::frame_matched(const ProbedFrame& left, const ProbedFrame& right,
                                     std::int64_t match_ns) noexcept {
  const double earned = kShare * static_cast<double>(match_ns);
  credit_ns_ += earned;
  std::array<RowMatch, RowProbe::kPatches> matches;
  RowProbe::Result result;
  std::int64_t spent = 0, now = 0;
  if (credit_ns_ > 0) {
    const std::int64_t begin = thread_cpu_ns();
    result = probe_.probe(left, right, matches);
    spent = thread_cpu_ns() - begin;
    now = monotonic_ns();
    // What the machine took from a thread meanwhile is not to be paid for with minutes of blindness.
    constexpr double kLargestDebt = 200;  // frames
    credit_ns_ = std::max(credit_ns_ - static_cast<double>(spent), -kLargestDebt * earned);
  }
  const std::lock_guard lock(mutex_);
  spent_ns_ += spent, matched_ns_ += match_ns;
  for (int i = 0; i < result.found; ++i) remember({now, true, matches[static_cast<std::size_t>(i)]});
  for (int i = 0; i < result.absent; ++i) remember({now, false, {}});
}

AlignmentFigures AlignmentMonitor::figures() const {
  std::vector<Point> newest;
  newest.reserve(kPoints);  // not while the matching thread may wait
  AlignmentFigures figures;
  {
    const std::lock_guard lock(mutex_);
    for (std::size_t back = 1; back <= std::min(count_, kPoints); ++back) {
      newest.push_back(points_[(count_ - back) % kPoints]);
    }
    if (matched_ns_ > 0)
      figures.cost_share = static_cast<double>(spent_ns_) / static_cast<double>(matched_ns_);
  }
  const std::int64_t now = monotonic_ns();
  std::vector<RowMatch> found;
  for (const Point& point : newest) {
    const double age_s = static_cast<double>(now - point.at_ns) * 1e-9;
    if (age_s > kLongest_s || (age_s > kWindow_s && (found.size() >= kEnough || figures.searched >= kMany)))
      break;
    ++figures.searched;
    if (point.found) found.push_back(point.match);
  }
  if (figures.searched > 0) {
    figures.found_share = static_cast<double>(found.size()) / static_cast<double>(figures.searched);
  }
  figures.misalignment = misalignment(found, image_);
  return figures;
}

}  // namespace stereod
