// Whether the calibration still fits the cameras, from the frames that are matched anyway.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>

#include "core/perception/epipolar_probe.h"

namespace stereod {

/// What the frames of the last seconds show.
struct EpipolarStats {
  std::optional<EpipolarError> epipolar_error;  ///< nothing: too few points were found to tell
  double found_share = 1;    ///< of the points that have texture, how many were found in the other image
  double usual_share = 0;    ///< the same while rows were seen to lie side by side; 0: they were not yet
  std::size_t searched = 0;  ///< so many points that is
  double cost_share = 0;     ///< time spent on it since the start / time spent on matching
};

/// Probes a frame now and then, so seldom that it stays below kShare of the time that matching takes,
/// whatever the CPU. While the rows lie side by side it looks near them only, and puts by a quarter of that
/// time; once the points that it looks for are gone, it searches far with all that it has saved, and only
/// that counts then. Remembers what was found in the last kWindow_s, or longer where that were few points.
class EpipolarMonitor {
 public:
  static constexpr double kShare = 0.02;

  EpipolarMonitor(Size image, int min_disparity, int disparities);

  /// A frame whose matching took `match_ns`. One thread; waits for nothing but stats() being read.
  void frame_matched(const ProbedFrame& left, const ProbedFrame& right, std::int64_t match_ns) noexcept;

  /// To be asked about once a second: it also decides from them how far to search from now on.
  EpipolarStats stats();

 private:
  static constexpr std::size_t kPoints = 1024;
  static constexpr double kWindow_s = 4, kMaxWindow_s = 30;
  static constexpr std::size_t kEnough = 60;  // points found; with fewer in the window older ones count too,
  static constexpr std::size_t kMany = 300;   // if so many were searched, not
  static constexpr std::size_t kManyFar =
      120;  // searched far with hardly any found: what was before does not count

  struct Point {
    std::int64_t at_ns;
    bool found;
    EpipolarMatch match;
  };

  void remember(const Point& point) noexcept;
  void earn(double ns) noexcept;
  bool may_spend(EpipolarProbe::Reach reach) const noexcept;
  void spend(double ns, EpipolarProbe::Reach reach) noexcept;
  void search_far() noexcept;

  Size image_;
  EpipolarProbe probe_;
  double purse_ns_ = 0, saved_ns_ = 0;  // time that probing may take; of the matching thread alone
  mutable std::mutex mutex_;
  std::array<Point, kPoints> points_{};  // a ring
  std::size_t count_ = 0;
  EpipolarProbe::Reach reach_ = EpipolarProbe::Reach::kNear;
  std::size_t far_since_ = 0;                        // count_ when it began to search far, the last time
  double found_lately_ = 0.5, found_usually_ = 0.5;  // share of the points searched near
  double found_together_ = 0;  // share found while rows were seen to lie side by side; 0: not yet
  std::int64_t spent_ns_ = 0, matched_ns_ = 0;
};

}  // namespace stereod
