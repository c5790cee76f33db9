// SPDX-License-Identifier: BSD-3-Clause
// Measures the epipolar error while the daemon runs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "core/perception/epipolar_probe.h"

namespace stereod {

/// Epipolar statistics of the last seconds.
struct EpipolarStats {
  std::optional<EpipolarError> epipolar_error;  ///< nothing: too few points were found
  double found_share = 1;    ///< share of the textured points that were found in the right image, 0…1
  double usual_share = 0;    ///< found_share while the epipolar error was small; 0: it was not small yet
  std::size_t searched = 0;  ///< number of textured points
  double cost_share = 0;     ///< time spent on probing / time spent on matching, since the start
};

/// Probes a few points of some frames, within a time budget of kBudgetShare of the matching time.
///
/// While the epipolar error is small, it searches near the expected row only and saves a quarter of the
/// budget as a reserve. When points are missing or the error is large, it searches far, may use the reserve,
/// and counts only what the far search finds. Remembers the points of the last kWindow_s, or of up to
/// kMaxWindow_s if those are few.
class EpipolarMonitor {
 public:
  static constexpr double kBudgetShare = 0.02;

  EpipolarMonitor(Size image, int min_disparity, int disparities);

  /// Takes a frame whose matching took @p match_ns [ns]. One thread; waits only while stats() copies.
  void frame_matched(const ProbedFrame& left, const ProbedFrame& right, std::int64_t match_ns) noexcept;

  /// Returns the statistics and decides from them how far to search from now on. Call it about once a second.
  EpipolarStats stats();

 private:
  static constexpr std::size_t kPoints = 1024;
  static constexpr double kWindow_s = 4, kMaxWindow_s = 30;
  // After kWindow_s the window ends once it has kEnoughFound found points or kEnoughSearched searched ones.
  static constexpr std::size_t kEnoughFound = 60, kEnoughSearched = 300;
  // A far search of kEnoughFar points with hardly any found replaces all earlier points.
  static constexpr std::size_t kEnoughFar = 120;

  struct Point {
    std::int64_t at_ns;
    bool found;
    EpipolarMatch match;
  };
  /// Points of the window that counts.
  struct Window {
    std::size_t searched = 0;
    std::size_t found_far = 0;         // by the present far search; they are at the front of `found`
    std::vector<EpipolarMatch> found;  // the newest first
  };

  void earn_budget(double ns) noexcept;
  bool has_budget(EpipolarProbe::Reach reach) const noexcept;
  void spend_budget(double ns, EpipolarProbe::Reach reach) noexcept;
  void remember(const Point& point) noexcept;
  void search_far() noexcept;
  Window select_window(const std::vector<Point>& newest, std::size_t far_points) const;
  std::optional<EpipolarError> measured_error(const Window& window) const;
  void choose_reach(const Window& window, EpipolarStats& stats) noexcept;

  const Size image_;
  EpipolarProbe probe_;
  // Time budget and reserve of probing [ns]. Used by the matching thread only.
  double budget_ns_ = 0, reserve_ns_ = 0;
  mutable std::mutex mutex_;
  std::array<Point, kPoints> points_{};  // a ring
  std::size_t count_ = 0;
  EpipolarProbe::Reach reach_ = EpipolarProbe::Reach::kNear;
  std::size_t far_since_ = 0;  // count_ when the latest far search began
  // Share of the points that the near search finds: over some 24 and some 240 points.
  double recent_found_share_ = 0.5, average_found_share_ = 0.5;
  double usual_found_share_ = 0;  // while the epipolar error was small; 0: not yet
  std::int64_t spent_ns_ = 0, matched_ns_ = 0;
};

}  // namespace stereod
