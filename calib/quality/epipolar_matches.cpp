// SPDX-License-Identifier: BSD-3-Clause
#include "calib/quality/epipolar_matches.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <optional>

#include "calib/base/opencv_image.h"

namespace stereod::calib {

namespace {

constexpr int kHalf = 8;  // half the side of a patch
constexpr int kMaxPoints = 500;

// Columns searched on each side of the patch.
struct SearchRange {
  int left, right;
};

// Returns the best match in `to` of the patch around `at` in `from`, to a pixel; nothing if it is ambiguous.
std::optional<cv::Point2f> find_patch(const cv::Mat& from, const cv::Mat& to, cv::Point2f at,
                                      SearchRange range) {
  const int x = cvRound(at.x), y = cvRound(at.y);
  const int up_down = std::max(6, from.rows / 40);
  const cv::Rect image(0, 0, from.cols, from.rows);
  const cv::Rect patch(x - kHalf, y - kHalf, 2 * kHalf + 1, 2 * kHalf + 1);
  const cv::Rect area = cv::Rect(patch.x - range.left, patch.y - up_down,
                                 patch.width + range.left + range.right, patch.height + 2 * up_down) &
                        image;
  if ((patch & image) != patch || area.width <= patch.width + 8 || area.height <= patch.height) {
    return std::nullopt;
  }
  cv::Mat correlation;
  cv::matchTemplate(to(area), from(patch), correlation, cv::TM_CCOEFF_NORMED);
  double best = 0, second = 0;
  cv::Point place;
  cv::minMaxLoc(correlation, nullptr, &best, nullptr, &place);
  // Outside the neighborhood of the best match the correlation must be clearly lower; a repeated pattern is not.
  cv::rectangle(correlation, place - cv::Point(4, 4), place + cv::Point(4, 4), cv::Scalar(-1), cv::FILLED);
  cv::minMaxLoc(correlation, nullptr, &second);
  if (best < 0.9 || second > best - 0.04) return std::nullopt;
  return cv::Point2f(static_cast<float>(area.x + place.x + kHalf),
                     static_cast<float>(area.y + place.y + kHalf));
}

}  // namespace

std::vector<EpipolarMatch> match_epipolar_points(GrayView left_view, GrayView right_view) {
  const cv::Mat left = as_opencv(left_view), right = as_opencv(right_view);
  std::vector<cv::Point2f> points;
  cv::goodFeaturesToTrack(left, points, kMaxPoints, 0.01, 7);
  const int far = left.cols / 4, near = 8;
  std::vector<cv::Point2f> from, to;
  for (const cv::Point2f& p : points) {
    const cv::Point2f start(std::round(p.x), std::round(p.y));
    const auto match = find_patch(left, right, start, {far, near});
    if (!match) continue;
    // The search in the opposite direction must return to the start.
    const auto back = find_patch(right, left, *match, {near, far});
    if (!back || cv::norm(*back - start) > 1.5) continue;
    from.push_back(start);
    to.push_back(*match);
  }
  std::vector<EpipolarMatch> matches;
  if (from.empty()) return matches;
  // Lucas-Kanade method, for a fraction of a pixel.
  std::vector<cv::Point2f> exact = to;
  std::vector<unsigned char> found;
  std::vector<float> difference;
  cv::calcOpticalFlowPyrLK(left, right, from, exact, found, difference, {2 * kHalf + 1, 2 * kHalf + 1}, 0,
                           cv::TermCriteria(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 40, 0.005),
                           cv::OPTFLOW_USE_INITIAL_FLOW);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const cv::Point2f moved = exact[i] - to[i];
    if (found[i] == 0 || std::hypot(moved.x, moved.y) > 2) continue;
    matches.push_back({from[i].x, from[i].y, from[i].y - exact[i].y, from[i].x - exact[i].x});
  }
  return matches;
}

}  // namespace stereod::calib
