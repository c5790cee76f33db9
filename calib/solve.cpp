#include "calib/solve.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "calib/board_search.h"
#include "calib/edge_width.h"
#include "calib/errors.h"
#include "calib/matched_boards.h"
#include "calib/pair_consensus.h"
#include "calib/progress.h"

namespace stereod {

namespace {

using Indices = std::vector<std::size_t>;

// A pair further off than this many times the median, and than the floor, does not belong.
constexpr double kOutlierFactor = 3;
constexpr double kCoarseFloorPx = 2;  // while each camera is known only for itself
constexpr double kFineFloorPx = 0.6;  // once both are solved together

std::string px(double value) {
  char text[32];
  std::snprintf(text, sizeof text, value < 10 ? "%.2f px" : "%.0f px", value);
  return text;
}

// The state of a solution while pairs are sorted out.
class Solver {
 public:
  Solver(const std::vector<PicturePair>& pictures, const SolveOptions& options, SolveResult& result)
      : image_(pictures.front().left.size()), options_(options), result_(result) {}

  void take(const std::vector<PicturePair>& pictures, const std::vector<PairSearch>& searches) {
    result_.pairs.resize(pictures.size());
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      PairResult& pair = result_.pairs[i];
      pair.name = pictures[i].name;
      pair.corners = searches[i].corners;
      pair.reason = searches[i].problem;
      const double left = searches[i].left_edge_px, right = searches[i].right_edge_px;
      if (pair.reason.empty() && std::max(left, right) > blur_limit_px(image_)) {
        pair.reason = std::string("blurred: the ") + (left > right ? "left" : "right") +
                      " picture's edges are " + px(std::max(left, right)) + " wide, allowed are " +
                      px(blur_limit_px(image_)) + "; hold the board still and focus the lens";
      }
      if (pair.reason.empty()) drop_if_seen_before(i);
      if (pair.reason.empty()) good_.push_back(i);
    }
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
    const double limit = std::max(kOutlierFactor * median(errors), kCoarseFloorPx);
    drop(good_, errors, limit, moved_reason);
    require_enough();
  }

  // Those at evenly spread places of the list that was given, or the next good ones after them: so one bad
  // pair more or less changes at most one of them.
  void split() {
    const std::size_t all = result_.pairs.size();
    Indices held;
    const auto is_free = [&](std::size_t i) {
      return std::find(good_.begin(), good_.end(), i) != good_.end() &&
             std::find(held.begin(), held.end(), i) == held.end();
    };
    const Indices places = evenly_spread(held_back_count(all), all);
    for (const std::size_t i : places) {
      if (is_free(i)) held.push_back(i);
    }
    for (const std::size_t place : places) {
      if (held.size() >= held_back_count(good_.size())) break;
      std::size_t i = place;
      while (!is_free(i)) i = (i + 1) % all;
      if (std::find(held.begin(), held.end(), place) == held.end()) held.push_back(i);
    }
    held.resize(std::min(held.size(), held_back_count(good_.size())));
    for (const std::size_t i : good_) {
      (std::find(held.begin(), held.end(), i) != held.end() ? held_back_ : used_).push_back(i);
    }
  }

  // Solves, and again without the worst pair while it is far worse than the others.
  void refine() {
    for (;;) {
      solve_used();
      std::vector<double> errors;
      for (const std::size_t i : used_) errors.push_back(result_.pairs[i].error_px = error_of(i));
      const double limit = std::max(kOutlierFactor * median(errors), kFineFloorPx);
      const auto worst = std::max_element(errors.begin(), errors.end());
      if (!(*worst > limit) || used_.size() < kFewestPairs) break;
      const auto place = worst - errors.begin();
      leave_out(used_[static_cast<std::size_t>(place)], moved_reason(*worst));
      used_.erase(used_.begin() + place);
    }
    std::vector<double> errors;
    for (const std::size_t i : held_back_) errors.push_back(result_.pairs[i].error_px = error_of(i));
    std::vector<double> used_errors;
    for (const std::size_t i : used_) used_errors.push_back(result_.pairs[i].error_px);
    // A pair that was not used fits less well; only one that is no honest pair is kept out of the check.
    const double limit = std::max(2 * kOutlierFactor * median(used_errors), 2 * kFineFloorPx);
    if (median(errors) <= limit) drop(held_back_, errors, limit, moved_reason);
  }

  void finish(const std::vector<PicturePair>& pictures) {
    try {
      result_.calibration = rectified_pair(cameras_.left, cameras_.right, cameras_.pose);
    } catch (const std::invalid_argument& refused) {
      throw CalibrationError(refused.what());
    }
    for (const std::size_t i : used_) {
      result_.pairs[i].fate = PairFate::kUsed;
      check(i);
    }
    PairCheck& mean = result_.held_back;
    const auto count = static_cast<double>(held_back_.size());
    for (const std::size_t i : held_back_) {
      result_.pairs[i].fate = PairFate::kHeldBack;
      const PairCheck& one = check(i);
      mean.row_error_px += one.row_error_px / count;
      mean.row_offset_px += one.row_offset_px / count;
      mean.disparity_error_px += one.disparity_error_px * one.disparity_error_px / count;
      mean.scale_error += one.scale_error / count;
      result_.worst_row_error_px = std::max(result_.worst_row_error_px, one.row_error_px);
    }
    mean.disparity_error_px = std::sqrt(mean.disparity_error_px);
    MatchedBoards matched(result_.calibration, result_.board);
    for (const std::size_t i : held_back_) matched.add(pictures[i], pose_of(result_.pairs[i].corners));
    constexpr std::size_t kEnough = 500;
    if (matched.points() >= kEnough) result_.matched_error_px = matched.deviation_px();
    CalibrationQuality& quality = result_.calibration.quality;
    quality.pairs_used = static_cast<int>(used_.size());
    quality.rms_px = rms_px_;
    quality.epipolar_error_px = mean.row_error_px;
  }

 private:
  static std::string moved_reason(double error) {
    return "does not agree with the others (off by " + px(error) +
           "): the board moved, or the two pictures were not taken at the same moment";
  }

  void leave_out(std::size_t i, std::string reason) {
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

  void drop_if_seen_before(std::size_t i) {
    const Corners& own = result_.pairs[i].corners.left;
    for (const std::size_t other : good_) {
      const Corners& theirs = result_.pairs[other].corners.left;
      const bool same = std::equal(own.begin(), own.end(), theirs.begin(), theirs.end(),
                                   [](Point2 a, Point2 b) { return a.x == b.x && a.y == b.y; });
      if (same) {
        result_.pairs[i].reason = "shows the same left picture as " + result_.pairs[other].name;
        return;
      }
    }
  }

  // Pictures whose corners are on no plane: a bent board, or corners found wrongly.
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
    return "the corners in the " + side + " picture are on no flat board (off by " + px(error) +
           "): the board is bent or partly hidden";
  }

  void require_enough() const {
    if (good_.size() >= kFewestPairs) return;
    std::string sentence = "there " + std::string(good_.size() == 1 ? "is " : "are ") +
                           std::to_string(good_.size()) + " good " + (good_.size() == 1 ? "pair" : "pairs") +
                           " of pictures; at least " + std::to_string(kFewestPairs) +
                           " are needed, better 15 and more";
    for (const PairResult& pair : result_.pairs) {
      if (pair.reason.empty()) continue;
      sentence += " (" + pair.name + ": " + pair.reason + ")";
      break;
    }
    throw CalibrationError(sentence);
  }

  CameraSolution solve_side(const Indices& pairs, bool left) const {
    std::vector<Corners> views;
    for (const std::size_t i : pairs) {
      const BoardPair& corners = result_.pairs[i].corners;
      views.push_back(left ? corners.left : corners.right);
    }
    return solve_camera(image_, result_.board, views, options_.lens);
  }

  void solve_used() {
    const CameraSolution left = solve_side(used_, true), right = solve_side(used_, false);
    result_.left_rms_px = left.rms_px, result_.right_rms_px = right.rms_px;
    std::vector<BoardPair> pairs;
    for (const std::size_t i : used_) pairs.push_back(result_.pairs[i].corners);
    const StereoSolution both = solve_stereo(result_.board, pairs, left.camera, right.camera, options_.lens);
    cameras_ = both.cameras;
    rms_px_ = both.rms_px;
  }

  BoardPose pose_of(const BoardPair& corners) const {
    return fitted_pose(cameras_, result_.board, corners,
                       solve_pose(cameras_.left, result_.board, corners.left));
  }

  double error_of(std::size_t i) const {
    const BoardPair& corners = result_.pairs[i].corners;
    return pair_error_px(cameras_, result_.board, corners, pose_of(corners));
  }

  const PairCheck& check(std::size_t i) {
    PairResult& pair = result_.pairs[i];
    return pair.check = check_pair(result_.calibration, result_.board, pair.corners, pose_of(pair.corners));
  }

  Size image_;
  const SolveOptions& options_;
  SolveResult& result_;
  Indices good_, used_, held_back_;
  StereoCameras cameras_;
  double rms_px_ = 0;
};

}  // namespace

int SolveResult::count(PairFate fate) const {
  return static_cast<int>(
      std::count_if(pairs.begin(), pairs.end(), [&](const PairResult& p) { return p.fate == fate; }));
}

SolveResult solve(const std::vector<PicturePair>& pictures, const SolveOptions& options) {
  if (pictures.size() < kFewestPairs) {
    throw CalibrationError(
        "there " +
        std::string(pictures.size() == 1 ? "is only one pair"
                                         : "are only " + std::to_string(pictures.size()) + " pairs") +
        " of pictures; at least " + std::to_string(kFewestPairs) + " are needed, better 15 and more");
  }
  SolveResult result;
  result.lens = options.lens;
  result.board = options.board ? *options.board : guess_board(pictures);
  result.board.square_m = options.square_m;
  Solver solver(pictures, options, result);
  solver.take(pictures, search_boards(pictures, result.board));
  Progress progress("calibrating", 4);
  solver.find_consensus();
  progress.step();
  solver.split();
  solver.refine();
  progress.step();
  solver.finish(pictures);
  progress.step();
  return result;
}

}  // namespace stereod
