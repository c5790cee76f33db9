// SPDX-License-Identifier: BSD-3-Clause
#include "calib/solve/matched_boards.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/geometry/depth.h"
#include "core/match/frame_matcher.h"
#include "core/rectify/rectify_map.h"
#include "daemon/config/config.h"

namespace stereod::calib {

namespace {

struct RectifiedImage {
  GrayImage image;
  ValidityMask mask;
};

RectifiedImage rectified(const CameraCalibration& camera, const GrayImage& image) {
  const RectifyMap map(camera, {image.size(), image.view().stride(), 1}, RectifyConfig{}.interpolation);
  RectifiedImage result{GrayImage(image.size()), map.mask()};
  map.gray_rows(image.row(0), {0, image.height()}, result.image.view());
  return result;
}

// A board in the rectified left image.
class RectifiedBoard {
 public:
  RectifiedBoard(const Calibration& calibration, const Board& board, const BoardPose& in_left)
      : calibration_(calibration),
        board_(board),
        rotation_(calibration.left.rotation * in_left.rotation),
        origin_(calibration.left.rotation * in_left.translation_m),
        normal_(rotation_ * Vector3{0, 0, 1}) {}

  // Returns the disparity of pixel (x, y) if it shows the board within its outermost inner corners.
  std::optional<double> disparity_at(double x, double y) const {
    const RectifiedProjection& p = calibration_.left.projection;
    const Vector3 ray{(x - p.cx) / p.fx, (y - p.cy) / p.fy, 1};
    const double depth = dot(normal_, origin_) / dot(normal_, ray);
    if (!(depth > 0)) return std::nullopt;
    const Vector3 from_origin{ray.x * depth - origin_.x, ray.y * depth - origin_.y, depth - origin_.z};
    const Vector3 on_board = transposed(rotation_) * from_origin;
    const double last_x = (board_.columns - 1) * board_.square_m,
                 last_y = (board_.rows - 1) * board_.square_m;
    if (on_board.x < 0 || on_board.y < 0 || on_board.x > last_x || on_board.y > last_y) return std::nullopt;
    return stereod::disparity_at(calibration_, depth);
  }

 private:
  static double dot(const Vector3& a, const Vector3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

  const Calibration& calibration_;
  const Board& board_;
  Matrix3 rotation_;
  Vector3 origin_, normal_;
};

}  // namespace

void MatchedBoards::add(const Calibration& calibration, const ImagePair& pair, const BoardPose& in_left) {
  const RectifiedBoard rectified_board(calibration, board_, in_left);
  const Size size = calibration.image;
  Image<float> truth(size);
  double max_disparity = 0, min_disparity = 1e9;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto disparity = rectified_board.disparity_at(x, y);
      truth.at(x, y) = static_cast<float>(disparity.value_or(-1));
      if (!disparity) continue;
      max_disparity = std::max(max_disparity, *disparity);
      min_disparity = std::min(min_disparity, *disparity);
    }
  }
  if (max_disparity < min_disparity) return;  // no pixel shows the board
  // Disparities searched beyond those of the board, so that the matcher can be wrong.
  constexpr int kMargin = 16;
  MatcherOptions options = Config{}.matcher;
  options.min_disparity = std::clamp(static_cast<int>(min_disparity) - kMargin, 0, 1024);
  options.disparities = std::clamp(static_cast<int>(max_disparity) + kMargin - options.min_disparity, 1, 256);
  WorkerPool pool(1);
  FrameMatcher matcher(options, size, pool);
  const RectifiedImage left = rectified(calibration.left, pair.left),
                       right = rectified(calibration.right, pair.right);
  matcher.use_masks(&left.mask, &right.mask);
  DisparityImage found(size);
  matcher.match(left.image.view(), right.image.view(), found.view());
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (truth.at(x, y) < 0 || found.at(x, y) == kInvalidDisparity) continue;
      const float disparity =
          static_cast<float>(found.at(x, y)) / static_cast<float>(options.units_per_pixel());
      errors_px_.push_back(std::abs(disparity - truth.at(x, y)));
    }
  }
}

double MatchedBoards::deviation_px() const {
  std::vector<float> errors = errors_px_;
  const auto place = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() * 68 / 100);
  std::nth_element(errors.begin(), place, errors.end());
  return static_cast<double>(*place);
}

}  // namespace stereod::calib
