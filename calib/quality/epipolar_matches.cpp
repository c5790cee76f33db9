#include "calib/quality/epipolar_matches.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "calib/base/opencv_image.h"

namespace stereod {

namespace {

constexpr int kHalf = 8;  // of a patch
constexpr int kMaxPoints = 500;

// How far from its place a patch is searched for, to the left and to the right.
struct Reach {
  int left, right;
};

// Where in the other image a patch looks most alike, to a pixel; nothing if that is not sure.
std::optional<cv::Point2f> find_again(const cv::Mat& left, const cv::Mat& right, cv::Point2f at,
                                      Reach reach) {
  const int x = cvRound(at.x), y = cvRound(at.y);
  const int up_down = std::max(6, left.rows / 40);
  const cv::Rect image(0, 0, left.cols, left.rows);
  const cv::Rect patch(x - kHalf, y - kHalf, 2 * kHalf + 1, 2 * kHalf + 1);
  const cv::Rect area = cv::Rect(patch.x - reach.left, patch.y - up_down,
                                 patch.width + reach.left + reach.right, patch.height + 2 * up_down) &
                        image;
  if ((patch & image) != patch || area.width <= patch.width + 8 || area.height <= patch.height) {
    return std::nullopt;
  }
  cv::Mat likeness;
  cv::matchTemplate(right(area), left(patch), likeness, cv::TM_CCOEFF_NORMED);
  double best = 0, second = 0;
  cv::Point place;
  cv::minMaxLoc(likeness, nullptr, &best, nullptr, &place);
  // The runner-up must be clearly worse, or the pattern repeats itself.
  cv::rectangle(likeness, place - cv::Point(4, 4), place + cv::Point(4, 4), cv::Scalar(-1), cv::FILLED);
  cv::minMaxLoc(likeness, nullptr, &second);
  if (best < 0.9 || second > best - 0.04) return std::nullopt;
  return cv::Point2f(static_cast<float>(area.x + place.x + kHalf),
                     static_cast<float>(area.y + place.y + kHalf));
}

}  // namespace

std::vector<EpipolarMatch> match_rows(GrayView left_view, GrayView right_view) {
  const cv::Mat left = as_opencv(left_view), right = as_opencv(right_view);
  std::vector<cv::Point2f> points;
  cv::goodFeaturesToTrack(left, points, kMaxPoints, 0.01, 7);
  const int far = left.cols / 4, near = 8;
  std::vector<cv::Point2f> from, to;
  for (const cv::Point2f& p : points) {
    const cv::Point2f start(std::round(p.x), std::round(p.y));
    const auto again = find_again(left, right, start, {far, near});
    if (!again) continue;
    // What is not found back from there was not the same thing.
    const auto back = find_again(right, left, *again, {near, far});
    if (!back || cv::norm(*back - start) > 1.5) continue;
    from.push_back(start);
    to.push_back(*again);
  }
  std::vector<EpipolarMatch> matches;
  if (from.empty()) return matches;
  // To fractions of a pixel, by Lucas and Kanade's method from there.
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

}  // namespace stereod
