// SPDX-License-Identifier: BSD-3-Clause
#include "calib/solve/board_pose.h"

#include <array>
#include <cmath>
#include <utility>

#include "calib/solve/vector_math.h"

namespace stereod::calib {

namespace {

constexpr std::size_t kParameters = 6;
using Parameters = std::array<double, kParameters>;

// Returns the pose after a small step: a rotation vector, then a translation.
BoardPose moved(const BoardPose& pose, const Parameters& step) {
  return {rotation_about({step[0], step[1], step[2]}) * pose.rotation,
          plus(pose.translation_m, {step[3], step[4], step[5]})};
}

double square_sum(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return sum;
}

// Solves a·x = b by Gaussian elimination with pivoting. Returns false if a is singular.
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

// The least-squares problem, linearized at one pose: its normal equations.
struct NormalEquations {
  std::array<Parameters, kParameters> matrix{};
  Parameters right{};
};

NormalEquations linearized(const PoseResiduals& residuals_at, const BoardPose& pose,
                           const std::vector<double>& residuals, double distance_m) {
  std::array<std::vector<double>, kParameters> slopes;
  for (std::size_t p = 0; p < kParameters; ++p) {
    Parameters step{};
    step[p] = p < 3 ? 1e-6 : 1e-6 * distance_m;
    slopes[p] = residuals_at(moved(pose, step));
    for (std::size_t i = 0; i < residuals.size(); ++i) slopes[p][i] = (slopes[p][i] - residuals[i]) / step[p];
  }
  NormalEquations normal;
  for (std::size_t p = 0; p < kParameters; ++p) {
    for (std::size_t q = 0; q < kParameters; ++q) {
      for (std::size_t i = 0; i < residuals.size(); ++i) normal.matrix[p][q] += slopes[p][i] * slopes[q][i];
    }
    for (std::size_t i = 0; i < residuals.size(); ++i) normal.right[p] -= slopes[p][i] * residuals[i];
  }
  return normal;
}

}  // namespace

BoardPose refine_pose(const PoseResiduals& residuals_at, BoardPose pose, double distance_m) {
  constexpr int kMaxSteps = 50;
  double damping = 1e-3;
  std::vector<double> residuals = residuals_at(pose);
  double sum = square_sum(residuals);
  for (int iteration = 0; iteration < kMaxSteps; ++iteration) {
    const NormalEquations normal = linearized(residuals_at, pose, residuals, distance_m);
    bool better = false;
    while (!better && damping < 1e9) {
      auto damped = normal.matrix;
      for (std::size_t p = 0; p < kParameters; ++p) damped[p][p] *= 1 + damping;
      Parameters step{};
      if (!solve(damped, normal.right, step)) return pose;
      const BoardPose next = moved(pose, step);
      const std::vector<double> next_residuals = residuals_at(next);
      const double next_sum = square_sum(next_residuals);
      better = next_sum < sum;
      damping *= better ? 0.1 : 10;
      if (better) {
        const bool converged = sum - next_sum < 1e-12 * sum;
        pose = next, residuals = next_residuals, sum = next_sum;
        if (converged) return pose;
      }
    }
    if (!better) return pose;
  }
  return pose;
}

}  // namespace stereod::calib
