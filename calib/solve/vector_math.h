// SPDX-License-Identifier: BSD-3-Clause
// Vector arithmetic of the solver.
#pragma once

#include <cmath>

#include "core/geometry/camera_model.h"

namespace stereod::calib {

inline Vector3 plus(const Vector3& a, const Vector3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector3 minus(const Vector3& a, const Vector3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline double length(const Vector3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

}  // namespace stereod::calib
