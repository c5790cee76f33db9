// SPDX-License-Identifier: BSD-3-Clause
#include "calib/board/board_finder.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "calib/base/opencv_image.h"
#include "calib/board/corner_order.h"
#include "calib/board/edge_width.h"

namespace stereod::calib {

namespace {

using Points = std::vector<cv::Point2f>;

double min_side(const Points& points, const Board& board) {
  double shortest = 1e9;
  const auto columns = static_cast<std::size_t>(board.columns);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if ((i + 1) % columns != 0) shortest = std::min(shortest, cv::norm(points[i + 1] - points[i]));
    if (i + columns < points.size()) shortest = std::min(shortest, cv::norm(points[i + columns] - points[i]));
  }
  return shortest;
}

// Refines corners to subpixel accuracy. The window stays clear of the neighboring corners.
void refine(const cv::Mat& image, const Board& board, Points& points) {
  const int half = std::clamp(static_cast<int>(min_side(points, board) * 0.4), 2, 11);
  cv::cornerSubPix(image, points, {half, half}, {-1, -1},
                   cv::TermCriteria(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 100, 1e-4));
}

// findChessboardCornersSB draws random numbers from a generator per thread. A fixed seed makes its result
// independent of the images that the thread searched before.
void reseed_random_numbers() { cv::theRNG().state = 4711; }

bool find_corners(const cv::Mat& image, const Board& board, Effort effort, Points& points) {
  const cv::Size pattern(board.columns, board.rows);
  const int flags = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE;
  if (effort == Effort::kLive) {
    return cv::findChessboardCorners(image, pattern, points, flags | cv::CALIB_CB_FAST_CHECK);
  }
  if (cv::findChessboardCorners(image, pattern, points, flags)) return true;
  reseed_random_numbers();
  return cv::findChessboardCornersSB(image, pattern, points, cv::CALIB_CB_NORMALIZE_IMAGE);
}

}  // namespace

std::optional<FoundBoard> find_board(GrayView view, const Board& board, Effort effort) {
  const cv::Mat image = as_opencv(view);
  Points points;
  if (!find_corners(image, board, effort, points)) return std::nullopt;
  refine(image, board, points);
  FoundBoard found;
  for (const cv::Point2f& p : points) {
    if (!(p.x >= 0 && p.y >= 0 && p.x <= static_cast<float>(image.cols - 1) &&
          p.y <= static_cast<float>(image.rows - 1)))
      return std::nullopt;
    found.corners.push_back({p.x, p.y});
  }
  found.corners = in_board_order(view, board, std::move(found.corners));
  if (effort == Effort::kThorough) found.edge_width_px = edge_width_px(view, board, found.corners);
  return found;
}

std::optional<Board> find_any_board(GrayView image) {
  cv::Mat corners, meta;
  const int flags = cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE | cv::CALIB_CB_LARGER;
  reseed_random_numbers();
  const bool found = cv::findChessboardCornersSB(as_opencv(image), cv::Size(3, 3), corners, flags, meta);
  if (!found || meta.cols < 3 || meta.rows < 3) return std::nullopt;
  return Board{std::max(meta.cols, meta.rows), std::min(meta.cols, meta.rows), 0};
}

}  // namespace stereod::calib
