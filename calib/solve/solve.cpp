#include "calib/solve/solve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "calib/base/errors.h"
#include "calib/board/board_search.h"
#include "calib/quality/edge_width.h"
#include "calib/quality/matched_boards.h"
#include "calib/solve/pair_consensus.h"
#include "daemon/base/progress.h"
#include "daemon/base/text.h"

namespace stereod {

namespace {

using Indices = std::vector<std::size_t>;

// A pair further off than this many times the median, and than the floor, does not belong.
constexpr double kOutlierFactor = 3;
constexpr double kCoarseFloorPx = 2;  // while each camera is known only for itself
constexpr double kFineFloorPx = 0.6;  // once both are solved together

std::string px(double value) { return fixed(value, value < 10 ? 2 : 0) + " px"; }

// The state of a solution while pairs are sorted out.
class Solver {
 public:
  Solver(const std::vector<ImagePair>& pictures, const SolveOptions& options, SolveResult& result)
      : image_(pictures.front().left.size()), options_(options), result_(result) {}

  void take(const std::vector<ImagePair>& pictures, const std::vector<PairSearch>& searches) {
    result_.pairs.resize(pictures.size());
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      PairResult& pair = result_.pairs[i];
      pair.name = pictures[i].name;
      pair.corners = searches[i].corners;
      pair.reason = searches[i].problem;
      const double left = searches[i].left_edge_px, right = searches[i].right_edge_px;
      if (pair.reason.empty() && std::max(left, right) > blur_limit_px(image_)) {
        pair.reason = std::string("blurred: the ") + (left > right ? "left" : "right") +
                      " image's edges are " + px(std::max(left, right)) + " wide, allowed are " +
                      px(blur_limit_px(image_)) + "; hold the board still and focus the lens";
      }
      if (pair.reason.empty()) drop_if_seen_before(i);
      if (pair.reason.empty()) good_.push_back(i);
    }
    seen_ = good_;
    require_enough();
  }

  // Every camera for itself, then the relative pose that most pairs agree on.
  void find_consensus() {
    const CameraModel left = solve_side(good_, true).camera, right = solve_side(good_, false).camera;
    drop_bent(left, right);
    std::vector<PosedPair> posed;
    for (const std::size_t i : good_) {
      const BoardPair& corners = result_.pairs[i].corners;
      posed.push_back({corners, solve_pose(left, result_.board, corners.left),
                       solve_pose(right, result_.board, corners.right)});
    }
    const std::vector<double> errors = disagreement_px({left, right, {}}, result_.board, posed);
    for (std::size_t place = 0; place < good_.size(); ++place) {
      result_.pairs[good_[place]].error_px = errors[place];
    }
    const double limit = std::max(kOutlierFactor * median(errors), kCoarseFloorPx);
    drop(good_, errors, limit, moved_reason);
    drop_same_left();
    require_enough();
  }

  // Solves, and again without the worst pair while it is far worse than the others.
  void refine() {
    for (;;) {
      solve_good();
      std::vector<double> errors;
      for (const std::size_t i : good_) {
        const BoardPair& corners = result_.pairs[i].corners;
        errors.push_back(pair_error_px(cameras_, result_.board, corners, pose_of(cameras_, corners)));
        result_.pairs[i].error_px = errors.back();
      }
      const double limit = std::max(kOutlierFactor * median(errors), kFineFloorPx);
      const auto worst = std::max_element(errors.begin(), errors.end());
      if (!(*worst > limit) || good_.size() < kMinPairs) break;
      const auto place = worst - errors.begin();
      leave_out(good_[static_cast<std::size_t>(place)], moved_reason(*worst));
      good_.erase(good_.begin() + place);
    }
    for (const std::size_t i : good_) result_.pairs[i].fate = PairFate::kUsed;
    require_two_places();
    result_.calibration = rectified(cameras_);
    result_.calibration.quality.pairs_used = static_cast<int>(good_.size());
    result_.calibration.quality.rms_px = rms_px_;
  }

  // Each group held back in turn.
  void cross_check(const std::vector<ImagePair>& pictures) {
    MatchedBoards matched(result_.board);
    const Indices groups = groups_of_good();
    for (std::size_t group = 0; group < kHeldBackGroups; ++group) {
      Indices held_back, others;
      for (std::size_t place = 0; place < good_.size(); ++place) {
        (groups[place] == group ? held_back : others).push_back(good_[place]);
      }
      if (held_back.empty()) continue;
      // What is found does not depend on where the search begins; from here it is short.
      const StereoRigEstimate cameras = solve_both(others, cameras_.left, cameras_.right).cameras;
      const Calibration calibration = rectified(cameras);
      for (const std::size_t i : held_back) {
        PairResult& pair = result_.pairs[i];
        const BoardPose pose = pose_of(cameras, pair.corners);
        pair.check = check_pair(calibration, result_.board, pair.corners, pose);
        matched.add(calibration, pictures[i], pose);
      }
    }
    PairCheck& mean = result_.held_back;
    const auto count = static_cast<double>(good_.size());
    for (const std::size_t i : good_) {
      const PairCheck& one = result_.pairs[i].check;
      mean.epipolar_error_px += one.epipolar_error_px / count;
      mean.row_offset_px += one.row_offset_px / count;
      mean.disparity_error_px += one.disparity_error_px * one.disparity_error_px / count;
      mean.scale_error += one.scale_error / count;
      result_.max_epipolar_error_px = std::max(result_.max_epipolar_error_px, one.epipolar_error_px);
    }
    mean.disparity_error_px = std::sqrt(mean.disparity_error_px);
    result_.calibration.quality.epipolar_error_px = mean.epipolar_error_px;
    constexpr std::size_t kEnough = 500;
    if (matched.points() >= kEnough) result_.matched_error_px = matched.deviation_px();
  }

 private:
  static std::string moved_reason(double error) {
    return "does not agree with the others (off by " + px(error) +
           "): the board moved, or the two images were not taken at the same moment";
  }

  // By the places of those that show a sharp board, whichever of them agree: so one that does not moves no
  // other. If that put most of those left into one group, by their own places.
  Indices groups_of_good() const {
    Indices groups;
    std::array<std::size_t, kHeldBackGroups> sizes{};
    for (const std::size_t i : good_) {
      const auto place = std::find(seen_.begin(), seen_.end(), i) - seen_.begin();
      groups.push_back(static_cast<std::size_t>(place) % kHeldBackGroups);
      ++sizes[groups.back()];
    }
    if (2 * *std::max_element(sizes.begin(), sizes.end()) > good_.size()) {
      for (std::size_t place = 0; place < groups.size(); ++place) groups[place] = place % kHeldBackGroups;
    }
    return groups;
  }

  void leave_out(std::size_t i, std::string reason) {
    result_.pairs[i].disagrees = true;
    result_.pairs[i].fate = PairFate::kLeftOut;
    result_.pairs[i].reason = std::move(reason);
  }

  void drop(Indices& from, const std::vector<double>& errors, double limit, std::string (*reason)(double)) {
    Indices kept;
    for (std::size_t place = 0; place < from.size(); ++place) {
      if (errors[place] <= limit) {
        kept.push_back(from[place]);
      } else {
        leave_out(from[place], reason(errors[place]));
      }
    }
    from = std::move(kept);
  }

  static bool same(const Corners& a, const Corners& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](Point2 one, Point2 other) { return one.x == other.x && one.y == other.y; });
  }

  void drop_if_seen_before(std::size_t i) {
    PairResult& own = result_.pairs[i];
    for (const std::size_t other : good_) {
      const PairResult& theirs = result_.pairs[other];
      if (!same(own.corners.left, theirs.corners.left) || !same(own.corners.right, theirs.corners.right))
        continue;
      own.reason = "shows the same two images as " + theirs.name;
      return;
    }
  }

  // Of several with one left image and different right ones, the one that agrees best with the others.
  void drop_same_left() {
    Indices by_error = good_, kept;
    std::stable_sort(by_error.begin(), by_error.end(), [this](std::size_t a, std::size_t b) {
      return result_.pairs[a].error_px < result_.pairs[b].error_px;
    });
    for (const std::size_t i : by_error) {
      const Corners& own = result_.pairs[i].corners.left;
      const auto better = std::find_if(kept.begin(), kept.end(), [&](std::size_t other) {
        return same(own, result_.pairs[other].corners.left);
      });
      if (better == kept.end()) {
        kept.push_back(i);
      } else {
        result_.pairs[i].reason = "shows the same left image as " + result_.pairs[*better].name +
                                  ", which agrees better with the others";
      }
    }
    std::sort(kept.begin(), kept.end());
    good_ = std::move(kept);
  }

  // Images whose corners are on no plane: a bent board, or corners found wrongly.
  void drop_bent(const CameraModel& left, const CameraModel& right) {
    for (const bool is_left : {true, false}) {
      const CameraModel& camera = is_left ? left : right;
      std::vector<double> errors;
      for (const std::size_t i : good_) {
        const BoardPair& pair = result_.pairs[i].corners;
        const Corners& corners = is_left ? pair.left : pair.right;
        errors.push_back(
            board_error_px(camera, result_.board, solve_pose(camera, result_.board, corners), corners));
      }
      const double limit = std::max(2 * kOutlierFactor * median(errors), kCoarseFloorPx);
      drop(good_, errors, limit, is_left ? bent_left_reason : bent_right_reason);
    }
    require_enough();
  }
  static std::string bent_left_reason(double error) { return bent_reason("left", error); }
  static std::string bent_right_reason(double error) { return bent_reason("right", error); }
  static std::string bent_reason(const std::string& side, double error) {
    return "the corners in the " + side + " image are on no flat board (off by " + px(error) +
           "): the board is bent or partly hidden";
  }

  void require_enough() const {
    if (good_.size() >= kMinPairs) return;
    std::string sentence = "there " + std::string(good_.size() == 1 ? "is " : "are ") +
                           std::to_string(good_.size()) + " good " + (good_.size() == 1 ? "pair" : "pairs") +
                           " of images; at least " + std::to_string(kMinPairs) +
                           " are needed, better 15 and more";
    for (const PairResult& pair : result_.pairs) {
      if (pair.reason.empty()) continue;
      sentence += " (" + pair.name + ": " + pair.reason + ")";
      break;
    }
    throw CalibrationError(sentence);
  }

  void require_two_places() const {
    const Vector3& t = cameras_.pose.translation_m;
    const double apart_m = std::hypot(t.x, t.y, t.z);
    if (apart_m > result_.board.square_m / 10) return;
    char millimeters[32];
    std::snprintf(millimeters, sizeof millimeters, "%.2f", 1000 * apart_m);
    throw CalibrationError(
        "left and right are images of one camera: they were taken " + std::string(millimeters) +
        " mm apart; give the left camera's images as left and the right camera's as right");
  }

  CameraSolution solve_side(const Indices& pairs, bool left) const {
    std::vector<Corners> views;
    for (const std::size_t i : pairs) {
      const BoardPair& corners = result_.pairs[i].corners;
      views.push_back(left ? corners.left : corners.right);
    }
    return solve_camera(image_, result_.board, views, options_.lens);
  }

  StereoSolution solve_both(const Indices& used, const CameraModel& left, const CameraModel& right) const {
    std::vector<BoardPair> pairs;
    for (const std::size_t i : used) pairs.push_back(result_.pairs[i].corners);
    return solve_stereo(result_.board, pairs, left, right, options_.lens);
  }

  void solve_good() {
    const CameraSolution left = solve_side(good_, true), right = solve_side(good_, false);
    result_.left_rms_px = left.rms_px, result_.right_rms_px = right.rms_px;
    const StereoSolution both = solve_both(good_, left.camera, right.camera);
    cameras_ = both.cameras;
    rms_px_ = both.rms_px;
  }

  static Calibration rectified(const StereoRigEstimate& cameras) {
    try {
      return rectified_pair(cameras.left, cameras.right, cameras.pose);
    } catch (const std::invalid_argument& refused) {
      throw CalibrationError(refused.what());
    }
  }

  BoardPose pose_of(const StereoRigEstimate& cameras, const BoardPair& corners) const {
    return fitted_pose(cameras, result_.board, corners,
                       solve_pose(cameras.left, result_.board, corners.left));
  }

  Size image_;
  const SolveOptions& options_;
  SolveResult& result_;
  Indices seen_, good_;
  StereoRigEstimate cameras_;
  double rms_px_ = 0;
};

}  // namespace

int SolveResult::count(PairFate fate) const {
  return static_cast<int>(
      std::count_if(pairs.begin(), pairs.end(), [&](const PairResult& p) { return p.fate == fate; }));
}

SolveResult solve(const std::vector<ImagePair>& pictures, const SolveOptions& options) {
  if (pictures.size() < kMinPairs) {
    throw CalibrationError(
        "there " +
        std::string(pictures.size() == 1 ? "is only one pair"
                                         : "are only " + std::to_string(pictures.size()) + " pairs") +
        " of images; at least " + std::to_string(kMinPairs) + " are needed, better 15 and more");
  }
  SolveOptions with_board = options;
  if (!with_board.board) with_board.board = guess_board(pictures);
  return solve_found(pictures, search_boards(pictures, *with_board.board), with_board);
}

SolveResult solve_found(const std::vector<ImagePair>& pictures, const std::vector<PairSearch>& found,
                        const SolveOptions& options) {
  SolveResult result;
  result.lens = options.lens;
  result.board = options.board.value();
  result.board.square_m = options.square_m;
  Solver solver(pictures, options, result);
  solver.take(pictures, found);
  Progress progress("calibrating", 3);
  solver.find_consensus();
  progress.step();
  solver.refine();
  progress.step();
  solver.cross_check(pictures);
  progress.step();
  return result;
}

}  // namespace stereod
