#include "calib/board/board_finder.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "calib/base/opencv_image.h"
#include "calib/board/corner_order.h"
#include "calib/quality/edge_width.h"

namespace stereod {

namespace {

using Points = std::vector<cv::Point2f>;

double shortest_side(const Points& points, const Board& board) {
  double shortest = 1e9;
  const auto columns = static_cast<std::size_t>(board.columns);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if ((i + 1) % columns != 0) shortest = std::min(shortest, cv::norm(points[i + 1] - points[i]));
    if (i + columns < points.size()) shortest = std::min(shortest, cv::norm(points[i + columns] - points[i]));
  }
  return shortest;
}

// The window must not reach the neighboring corners.
void refine(const cv::Mat& image, const Board& board, Points& points) {
  const int half = std::clamp(static_cast<int>(shortest_side(points, board) * 0.4), 2, 11);
  cv::cornerSubPix(image, points, {half, half}, {-1, -1},
                   cv::TermCriteria(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 100, 1e-4));
}

// findChessboardCornersSB draws random numbers, from a source that each thread has of its own: what it finds
// is not to depend on which thread looked at what before.
void begin_random_numbers_anew() { cv::theRNG().state = 4711; }

bool find(const cv::Mat& image, const Board& board, Effort effort, Points& points) {
  const cv::Size pattern(board.columns, board.rows);
  const int flags = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE;
  if (effort == Effort::kLive) {
    return cv::findChessboardCorners(image, pattern, points, flags | cv::CALIB_CB_FAST_CHECK);
  }
  if (cv::findChessboardCorners(image, pattern, points, flags)) return true;
  begin_random_numbers_anew();
  return cv::findChessboardCornersSB(image, pattern, points, cv::CALIB_CB_NORMALIZE_IMAGE);
}

}  // namespace

std::optional<FoundBoard> find_board(GrayView picture, const Board& board, Effort effort) {
  const cv::Mat image = as_opencv(picture);
  Points points;
  if (!find(image, board, effort, points)) return std::nullopt;
  refine(image, board, points);
  FoundBoard found;
  for (const cv::Point2f& p : points) {
    if (!(p.x >= 0 && p.y >= 0 && p.x <= static_cast<float>(image.cols - 1) &&
          p.y <= static_cast<float>(image.rows - 1)))
      return std::nullopt;
    found.corners.push_back({p.x, p.y});
  }
  found.corners = in_board_order(picture, board, std::move(found.corners));
  if (effort == Effort::kThorough) found.edge_width_px = edge_width_px(picture, board, found.corners);
  return found;
}

std::optional<Board> find_any_board(GrayView picture) {
  cv::Mat corners, meta;
  const int flags = cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE | cv::CALIB_CB_LARGER;
  begin_random_numbers_anew();
  const bool found = cv::findChessboardCornersSB(as_opencv(picture), cv::Size(3, 3), corners, flags, meta);
  if (!found || meta.cols < 3 || meta.rows < 3) return std::nullopt;
  return Board{std::max(meta.cols, meta.rows), std::min(meta.cols, meta.rows), 0};
}

}  // namespace stereod
