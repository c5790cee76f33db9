// SPDX-License-Identifier: BSD-3-Clause
#include "calib/interop/interop_checks.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "calib/quality/distortion_foldover.h"
#include "calib/quality/verdict.h"
#include "daemon/base/file_error.h"

namespace stereod::calib {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Returns the largest difference between m·mᵀ and the identity.
double orthonormality_error(const Matrix3& m) {
  const Matrix3 product = m * transposed(m);
  double max_error = 0;
  for (std::size_t i = 0; i < 9; ++i)
    max_error = std::max(max_error, std::abs(product.m[i] - Matrix3{}.m[i]));
  return max_error;
}

}  // namespace

Matrix3 exact_rotation(const Matrix3& m) {
  constexpr double kRepairable = 2e-3;
  if (is_rotation(m) || !(orthonormality_error(m) < kRepairable)) return m;
  Matrix3 r = m;
  // Newton's iteration for the orthogonal polar factor, R ← R·(3·I − Rᵀ·R)/2.
  for (int round = 0; round < 4; ++round) {
    Matrix3 step = transposed(r) * r;
    for (std::size_t i = 0; i < 9; ++i) step.m[i] = (3 * Matrix3{}.m[i] - step.m[i]) / 2;
    r = r * step;
  }
  return r;
}

void require_plausible(const CameraModel& camera, const std::string& name,
                       const std::filesystem::path& file) {
  if (const auto problem = problem_with_camera(name, camera))
    throw FileError(file.string() + ": " + *problem);
  const double share = distortion_foldover(camera);
  if (grade_of_foldover(share) != Grade::kDoAgain) return;
  throw FileError(
      file.string() + ": the " + name + " camera's distortion coefficients fold " +
      std::to_string(std::lround(100 * share)) +
      " % of the image over itself, which no lens does; check that they belong to this lens model and their order");
}

bool is_camera_matrix(const std::vector<double>& k) {
  return k[1] == 0 && k[3] == 0 && k[6] == 0 && k[7] == 0 && k[8] == 1;
}

std::string shortest_decimal(double number) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

double right_shift(const Calibration& c) {
  const double fx = c.right.projection.fx, product = -fx * c.baseline_m;
  // Rounding of the quotient and of the product changes the value by at most two steps.
  double candidate = std::nextafter(std::nextafter(product, -kInfinity), -kInfinity), best = product;
  for (int step = 0; step < 5; ++step, candidate = std::nextafter(candidate, kInfinity)) {
    if (-candidate / fx == c.baseline_m && shortest_decimal(candidate).size() < shortest_decimal(best).size())
      best = candidate;
  }
  return best;
}

Calibration validated(Calibration calibration, const std::filesystem::path& file) {
  auto problem = problem_with(calibration);
  if (!problem) problem = problem_with_view(calibration);
  if (problem) throw FileError(file.string() + ": " + *problem);
  calibration.id = calibration_id(calibration);
  return calibration;
}

}  // namespace stereod::calib
