// SPDX-License-Identifier: BSD-3-Clause
#include "calib/solve/pair_selection.h"

#include <algorithm>
#include <utility>

#include "calib/base/errors.h"
#include "calib/base/statistics.h"
#include "calib/base/text.h"
#include "calib/board/edge_width.h"
#include "calib/solve/pair_consensus.h"

namespace stereod::calib {

namespace {

// Outliers below this error are kept while each camera is solved alone.
constexpr double kMinOutlierError_px = 2;

std::string px(double value) { return fixed(value, value < 10 ? 2 : 0) + " px"; }

std::string moved_reason(double error_px) {
  return "outlier (error " + px(error_px) +
         "): the board moved, or the two images were not taken at the same time";
}

std::string bent_reason(const char* side, double error_px) {
  return std::string("outlier (error ") + px(error_px) + "): the corners in the " + side +
         " image do not lie on a flat board; the board is bent or partly hidden";
}
std::string bent_left_reason(double error_px) { return bent_reason("left", error_px); }
std::string bent_right_reason(double error_px) { return bent_reason("right", error_px); }

bool equal(const Corners& a, const Corners& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](Point2 p, Point2 q) { return p.x == q.x && p.y == q.y; });
}

std::string blur_problem(const PairSearch& search, double limit_px) {
  const double left = search.left_edge_px, right = search.right_edge_px;
  if (std::max(left, right) <= limit_px) return "";
  return std::string("blurred: edges in the ") + (left > right ? "left" : "right") + " image are " +
         px(std::max(left, right)) + " wide, allowed are up to " + px(limit_px) +
         "; hold the board still and focus the lens";
}

}  // namespace

void PairSelection::select_usable(const std::vector<ImagePair>& images,
                                  const std::vector<PairSearch>& searches) {
  result_.pairs.resize(images.size());
  for (std::size_t i = 0; i < images.size(); ++i) {
    PairResult& pair = result_.pairs[i];
    pair.name = images[i].name;
    pair.corners = searches[i].corners;
    pair.reason = searches[i].problem;
    if (pair.reason.empty()) pair.reason = blur_problem(searches[i], blur_limit_px(solver_.image()));
    if (pair.reason.empty()) reject_if_repeated(i);
    if (pair.reason.empty()) selected_.push_back(i);
  }
  usable_ = selected_;
  require_enough();
}

void PairSelection::reject_outliers() {
  const CameraModel left = solver_.camera(selected_, Side::kLeft).camera;
  const CameraModel right = solver_.camera(selected_, Side::kRight).camera;
  reject_bent(left, Side::kLeft);
  reject_bent(right, Side::kRight);
  require_enough();
  std::vector<PosedPair> posed;
  for (const std::size_t i : selected_) {
    const BoardPair& corners = result_.pairs[i].corners;
    posed.push_back({corners, solve_pose(left, result_.board, corners.left),
                     solve_pose(right, result_.board, corners.right)});
  }
  const std::vector<double> errors = consensus_errors_px({left, right, {}}, result_.board, posed);
  for (std::size_t position = 0; position < selected_.size(); ++position) {
    result_.pairs[selected_[position]].error_px = errors[position];
  }
  reject_above(std::max(kOutlierFactor * median(errors), kMinOutlierError_px), errors, moved_reason);
  reject_repeated_left();
  require_enough();
}

void PairSelection::reject_moved(std::size_t position, double error_px) {
  reject(selected_[position], moved_reason(error_px));
  selected_.erase(selected_.begin() + static_cast<std::ptrdiff_t>(position));
}

void PairSelection::reject(std::size_t index, std::string reason) {
  PairResult& pair = result_.pairs[index];
  pair.is_outlier = true;
  pair.outcome = PairOutcome::kRejected;
  pair.reason = std::move(reason);
}

void PairSelection::reject_above(double limit_px, const std::vector<double>& errors_px,
                                 std::string (*reason)(double)) {
  PairIndices kept;
  for (std::size_t position = 0; position < selected_.size(); ++position) {
    if (errors_px[position] <= limit_px) {
      kept.push_back(selected_[position]);
    } else {
      reject(selected_[position], reason(errors_px[position]));
    }
  }
  selected_ = std::move(kept);
}

void PairSelection::reject_if_repeated(std::size_t index) {
  PairResult& pair = result_.pairs[index];
  for (const std::size_t earlier : selected_) {
    const PairResult& other = result_.pairs[earlier];
    if (!equal(pair.corners.left, other.corners.left) || !equal(pair.corners.right, other.corners.right))
      continue;
    pair.reason = "has the same two images as " + other.name;
    return;
  }
}

void PairSelection::reject_bent(const CameraModel& camera, Side side) {
  const bool is_left = side == Side::kLeft;
  std::vector<double> errors;
  for (const std::size_t i : selected_) {
    const BoardPair& pair = result_.pairs[i].corners;
    const Corners& corners = is_left ? pair.left : pair.right;
    errors.push_back(
        board_error_px(camera, result_.board, solve_pose(camera, result_.board, corners), corners));
  }
  reject_above(std::max(2 * kOutlierFactor * median(errors), kMinOutlierError_px), errors,
               is_left ? bent_left_reason : bent_right_reason);
}

// Of several pairs with the same left image and different right images, keeps the one with the smallest error.
void PairSelection::reject_repeated_left() {
  PairIndices by_error = selected_, kept;
  std::stable_sort(by_error.begin(), by_error.end(), [this](std::size_t a, std::size_t b) {
    return result_.pairs[a].error_px < result_.pairs[b].error_px;
  });
  for (const std::size_t i : by_error) {
    const Corners& left = result_.pairs[i].corners.left;
    const auto better = std::find_if(kept.begin(), kept.end(), [&](std::size_t other) {
      return equal(left, result_.pairs[other].corners.left);
    });
    if (better == kept.end()) {
      kept.push_back(i);
    } else {
      result_.pairs[i].reason =
          "has the same left image as " + result_.pairs[*better].name + ", which has a smaller error";
    }
  }
  std::sort(kept.begin(), kept.end());
  selected_ = std::move(kept);
}

void PairSelection::require_enough() const {
  if (selected_.size() >= kMinPairs) return;
  std::string sentence = "found " + std::to_string(selected_.size()) + " usable " +
                         (selected_.size() == 1 ? "pair" : "pairs") + " of images; at least " +
                         std::to_string(kMinPairs) + " are needed, 15 or more are better";
  for (const PairResult& pair : result_.pairs) {
    if (pair.reason.empty()) continue;
    sentence += " (" + pair.name + ": " + pair.reason + ")";
    break;
  }
  throw CalibrationError(sentence);
}

}  // namespace stereod::calib
