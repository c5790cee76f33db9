#include "calib/exchange.h"

#include <algorithm>
#include <cmath>

#include "daemon/config/file_error.h"

namespace stereod {

namespace {

// How far m·mᵀ is from the identity, at most.
double deviation(const Matrix3& m) {
  const Matrix3 product = m * transposed(m);
  double worst = 0;
  for (std::size_t i = 0; i < 9; ++i) worst = std::max(worst, std::abs(product.m[i] - Matrix3{}.m[i]));
  return worst;
}

}  // namespace

Matrix3 exact_rotation(const Matrix3& m) {
  constexpr double kExact = 1e-7, kRepairable = 2e-3;
  Matrix3 r = m;
  if (!(deviation(r) > kExact) || !(deviation(r) < kRepairable)) return m;
  // Newton's iteration for the orthogonal polar factor, R ← R·(3·I − Rᵀ·R)/2.
  for (int round = 0; round < 4; ++round) {
    Matrix3 step = transposed(r) * r;
    for (std::size_t i = 0; i < 9; ++i) step.m[i] = (3 * Matrix3{}.m[i] - step.m[i]) / 2;
    r = r * step;
  }
  return r;
}

Calibration sound_or_refused(Calibration calibration, const std::filesystem::path& file) {
  if (const auto problem = problem_with(calibration)) throw FileError(file.string() + ": " + *problem);
  calibration.id = calibration_id(calibration);
  return calibration;
}

}  // namespace stereod
