#include "calib/solve/pair_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "core/geometry/depth.h"

namespace stereod {

namespace {

constexpr std::size_t kParameters = 6;
using Parameters = std::array<double, kParameters>;

Vector3 plus(const Vector3& a, const Vector3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vector3 minus(const Vector3& a, const Vector3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double length(const Vector3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

Point2 project(const CameraModel& camera, const Vector3& p) {
  constexpr double kNearest = 1e-6;  // what would be behind the camera is as good as infinitely far off
  const double z = std::max(p.z, kNearest);
  return camera.to_pixel(camera.distort({p.x / z, p.y / z}));
}

// A small step from a pose: a rotation vector, then a translation.
BoardPose moved(const BoardPose& pose, const Parameters& step) {
  return {rotation_about({step[0], step[1], step[2]}) * pose.rotation,
          plus(pose.translation_m, {step[3], step[4], step[5]})};
}

void add_errors(const CameraModel& camera, const Board& board, const BoardPose& pose, const Corners& corners,
                std::vector<double>& errors) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point2 p = project(camera, plus(pose.rotation * board_point(board, i), pose.translation_m));
    errors.push_back(p.x - corners[i].x);
    errors.push_back(p.y - corners[i].y);
  }
}

double square_sum(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return sum;
}

// Gaussian elimination with pivots; false if there is no one answer.
bool solve(std::array<Parameters, kParameters> a, Parameters b, Parameters& x) {
  for (std::size_t i = 0; i < kParameters; ++i) {
    std::size_t pivot = i;
    for (std::size_t r = i + 1; r < kParameters; ++r) {
      if (std::abs(a[r][i]) > std::abs(a[pivot][i])) pivot = r;
    }
    if (!(std::abs(a[pivot][i]) > 1e-300)) return false;
    std::swap(a[i], a[pivot]), std::swap(b[i], b[pivot]);
    for (std::size_t r = i + 1; r < kParameters; ++r) {
      const double factor = a[r][i] / a[i][i];
      for (std::size_t c = i; c < kParameters; ++c) a[r][c] -= factor * a[i][c];
      b[r] -= factor * b[i];
    }
  }
  for (std::size_t i = kParameters; i-- > 0;) {
    double rest = b[i];
    for (std::size_t c = i + 1; c < kParameters; ++c) rest -= a[i][c] * x[c];
    x[i] = rest / a[i][i];
  }
  return true;
}

using ErrorsAt = std::function<std::vector<double>(const BoardPose&)>;

BoardPose least_squares(const ErrorsAt& errors_at, BoardPose pose, double reach) {
  constexpr int kMaxSteps = 50;
  double damping = 1e-3;
  std::vector<double> errors = errors_at(pose);
  double sum = square_sum(errors);
  for (int iteration = 0; iteration < kMaxSteps; ++iteration) {
    std::array<std::vector<double>, kParameters> slopes;
    for (std::size_t p = 0; p < kParameters; ++p) {
      Parameters step{};
      step[p] = p < 3 ? 1e-6 : 1e-6 * reach;
      slopes[p] = errors_at(moved(pose, step));
      for (std::size_t i = 0; i < errors.size(); ++i) slopes[p][i] = (slopes[p][i] - errors[i]) / step[p];
    }
    std::array<Parameters, kParameters> normal{};
    Parameters right{};
    for (std::size_t p = 0; p < kParameters; ++p) {
      for (std::size_t q = 0; q < kParameters; ++q) {
        for (std::size_t i = 0; i < errors.size(); ++i) normal[p][q] += slopes[p][i] * slopes[q][i];
      }
      for (std::size_t i = 0; i < errors.size(); ++i) right[p] -= slopes[p][i] * errors[i];
    }
    bool better = false;
    while (!better && damping < 1e9) {
      auto damped = normal;
      for (std::size_t p = 0; p < kParameters; ++p) damped[p][p] *= 1 + damping;
      Parameters step{};
      if (!solve(damped, right, step)) return pose;
      const BoardPose next = moved(pose, step);
      const std::vector<double> next_errors = errors_at(next);
      const double next_sum = square_sum(next_errors);
      better = next_sum < sum;
      damping *= better ? 0.1 : 10;
      if (better) {
        const bool converged = sum - next_sum < 1e-12 * sum;
        pose = next, errors = next_errors, sum = next_sum;
        if (converged) return pose;
      }
    }
    if (!better) return pose;
  }
  return pose;
}

// Triangulates; NaN where that is impossible.
Vector3 point_of(const Calibration& c, Point2 in_left, Point2 in_right) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto left = rectified_point(c.left, in_left), right = rectified_point(c.right, in_right);
  if (!left || !right) return {kNone, kNone, kNone};
  const RectifiedProjection& projection = c.left.projection;
  const double z = depth_m(c, left->x - right->x);
  return {(left->x - projection.cx) / projection.fx * z,
          ((left->y + right->y) / 2 - projection.cy) / projection.fy * z, z};
}

}  // namespace

double board_error_px(const CameraModel& camera, const Board& board, const BoardPose& pose,
                      const Corners& corners) {
  std::vector<double> errors;
  add_errors(camera, board, pose, corners, errors);
  return std::sqrt(square_sum(errors) / static_cast<double>(corners.size()));
}

BoardPose seen_from_right(const StereoPose& pose, const BoardPose& in_left) {
  return {pose.rotation * in_left.rotation, plus(pose.rotation * in_left.translation_m, pose.translation_m)};
}

StereoPose relative_pose(const BoardPose& in_left, const BoardPose& in_right) {
  const Matrix3 rotation = in_right.rotation * transposed(in_left.rotation);
  return {rotation, minus(in_right.translation_m, rotation * in_left.translation_m)};
}

BoardPose fitted_pose(const StereoRigEstimate& cameras, const Board& board, const BoardPair& pair,
                      const BoardPose& guess) {
  const auto errors_at = [&](const BoardPose& pose) {
    std::vector<double> errors;
    add_errors(cameras.left, board, pose, pair.left, errors);
    add_errors(cameras.right, board, seen_from_right(cameras.pose, pose), pair.right, errors);
    return errors;
  };
  return least_squares(errors_at, guess, length(guess.translation_m));
}

double pair_error_px(const StereoRigEstimate& cameras, const Board& board, const BoardPair& pair,
                     const BoardPose& in_left) {
  const double left = board_error_px(cameras.left, board, in_left, pair.left);
  const double right =
      board_error_px(cameras.right, board, seen_from_right(cameras.pose, in_left), pair.right);
  return std::sqrt((left * left + right * right) / 2);
}

PairCheck check_pair(const Calibration& calibration, const Board& board, const BoardPair& pair,
                     const BoardPose& in_left) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  PairCheck check;
  const auto columns = static_cast<std::size_t>(board.columns);
  const std::size_t count = pair.left.size();
  double squares = 0, rows = 0, offset = 0, behind = 0, n = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto left = rectified_point(calibration.left, pair.left[i]);
    const auto right = rectified_point(calibration.right, pair.right[i]);
    if (!left || !right) continue;  // the lens model breaks down here
    n += 1;
    rows += std::abs(left->y - right->y);
    offset += left->y - right->y;
    const double disparity = left->x - right->x + disparity_offset_px(calibration);
    behind += disparity < 0 ? 1 : 0;
    const Vector3 p =
        calibration.left.rotation * plus(in_left.rotation * board_point(board, i), in_left.translation_m);
    const double error = left->x - right->x - disparity_at(calibration, p.z);
    squares += error * error;
  }
  if (n < 0.9 * static_cast<double>(count)) return {kNone, kNone, kNone, kNone, 0};
  check.epipolar_error_px = rows / n;
  check.row_offset_px = offset / n;
  check.behind = behind / n;
  check.disparity_error_px = std::sqrt(squares / n);
  // Both diagonals: the longest lengths that the board has, so noise weighs least.
  const auto measured = [&](std::size_t from, std::size_t to) {
    const Vector3 a = point_of(calibration, pair.left[from], pair.right[from]);
    return length(minus(point_of(calibration, pair.left[to], pair.right[to]), a));
  };
  const double truth = 2 * length(board_point(board, count - 1));
  check.scale_error = (measured(0, count - 1) + measured(columns - 1, count - columns)) / truth - 1;
  // A corner that cannot be measured says nothing about the size.
  if (!std::isfinite(check.scale_error)) check.scale_error = 0;
  return check;
}

}  // namespace stereod
