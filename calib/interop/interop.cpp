#include "calib/interop/interop.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/quality/distortion_foldover.h"
#include "calib/quality/verdict.h"
#include "daemon/base/file_error.h"
#include "daemon/base/text.h"

namespace stereod {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// How far m·mᵀ is from the identity, at most.
double deviation(const Matrix3& m) {
  const Matrix3 product = m * transposed(m);
  double worst = 0;
  for (std::size_t i = 0; i < 9; ++i) worst = std::max(worst, std::abs(product.m[i] - Matrix3{}.m[i]));
  return worst;
}

}  // namespace

Matrix3 exact_rotation(const Matrix3& m) {
  constexpr double kRepairable = 2e-3;
  if (is_rotation(m) || !(deviation(m) < kRepairable)) return m;
  Matrix3 r = m;
  // Newton's iteration for the orthogonal polar factor, R ← R·(3·I − Rᵀ·R)/2.
  for (int round = 0; round < 4; ++round) {
    Matrix3 step = transposed(r) * r;
    for (std::size_t i = 0; i < 9; ++i) step.m[i] = (3 * Matrix3{}.m[i] - step.m[i]) / 2;
    r = r * step;
  }
  return r;
}

void refuse_absurd(const CameraModel& camera, const std::string& name, const std::filesystem::path& file) {
  if (const auto problem = problem_with_camera(name, camera))
    throw FileError(file.string() + ": " + *problem);
  const double share = distortion_foldover(camera);
  if (grade_of_foldover(share) != Grade::kDoAgain) return;
  throw FileError(
      file.string() + ": the " + name + " camera's distortion coefficients fold " +
      std::to_string(std::lround(100 * share)) +
      " % of the image over itself, which no lens does; are they of this lens model, and in order?");
}

bool is_camera_matrix(const std::vector<double>& k) {
  return k[1] == 0 && k[3] == 0 && k[6] == 0 && k[7] == 0 && k[8] == 1;
}

double right_shift(const Calibration& c) {
  const double fx = c.right.projection.fx, product = -fx * c.baseline_m;
  // Rounding of the quotient and of the product: two steps at most.
  double before = std::nextafter(std::nextafter(product, -kInfinity), -kInfinity), best = product;
  for (int step = 0; step < 5; ++step, before = std::nextafter(before, kInfinity)) {
    if (-before / fx == c.baseline_m && exact(before).size() < exact(best).size()) best = before;
  }
  return best;
}

Calibration sound_or_refused(Calibration calibration, const std::filesystem::path& file) {
  auto problem = problem_with(calibration);
  if (!problem) problem = problem_with_view(calibration);
  if (problem) throw FileError(file.string() + ": " + *problem);
  calibration.id = calibration_id(calibration);
  return calibration;
}

}  // namespace stereod
