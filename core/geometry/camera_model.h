// SPDX-License-Identifier: BSD-3-Clause
// Camera models: from a direction to a pixel and back.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/base/image.h"

namespace stereod {

/// A point of a plane: [px], or normalized image coordinates (x/z, y/z).
struct Point2 {
  double x = 0;
  double y = 0;
};

/// A point or direction: x to the right, y down, z forward.
struct Vector3 {
  double x = 0;
  double y = 0;
  double z = 0;
};

/// A 3×3 matrix, row by row. Initialized to the identity.
struct Matrix3 {
  std::array<double, 9> m{1, 0, 0, 0, 1, 0, 0, 0, 1};

  double operator()(int row, int column) const {
    return m[static_cast<std::size_t>(row) * 3 + static_cast<std::size_t>(column)];
  }
  friend bool operator==(const Matrix3&, const Matrix3&) = default;
};

Matrix3 operator*(const Matrix3& a, const Matrix3& b);
Vector3 operator*(const Matrix3& a, const Vector3& v);
Matrix3 transposed(const Matrix3& a);
double determinant(const Matrix3& a);

/// Returns the rotation by |@p v| radians about the direction of @p v (Rodrigues' formula).
Matrix3 rotation_about(const Vector3& v);

/// How a lens bends rays.
enum class LensModel {
  kPinhole,  ///< rational radial, tangential, thin prism, tilted sensor
  kFisheye,  ///< equidistant: the distance from the center grows with the angle
};

/// A camera and its lens, with the models and names of OpenCV (docs.opencv.org, calib3d and fisheye). Point
/// (0, 0) is the center of the top left pixel. With all coefficients 0 the camera is a pinhole or an
/// equidistant lens.
///
/// Pinhole: Brown 1966; Claus and Fitzgibbon 2005 for the denominator; Weng, Cohen and Herniou 1992 for the
/// thin prism; Louhichi et al. 2007 for the tilted sensor. Fisheye: Kannala and Brandt 2006, θ' = θ(1 + k1·θ²
/// + k2·θ⁴ + k3·θ⁶ + k4·θ⁸); the other coefficients are ignored.
struct CameraModel {
  Size image;
  double fx = 0, fy = 0;          ///< focal lengths in pixels
  double cx = 0, cy = 0;          ///< principal point in pixels
  double k1 = 0, k2 = 0;          ///< radial, numerator; fisheye
  double p1 = 0, p2 = 0;          ///< tangential
  double k3 = 0;                  ///< radial, numerator; fisheye
  double k4 = 0, k5 = 0, k6 = 0;  ///< radial, denominator; k4 also fisheye
  double s1 = 0, s2 = 0;          ///< thin prism, in x
  double s3 = 0, s4 = 0;          ///< thin prism, in y
  double tau_x = 0, tau_y = 0;    ///< tilt of the sensor about its x and y axes, radians, below π/2
  LensModel lens = LensModel::kPinhole;

  /// Returns the normalized coordinates behind the lens of those of a ray before it.
  Point2 distort(Point2 undistorted) const;

  /// The inverse of distort(), by Newton's method to 1e-12. Returns nullopt where it does not converge: for
  /// points farther out than the model can bend a ray, and for rays of a fisheye 90° or more off the axis.
  /// Near the image center it converges for every real lens.
  std::optional<Point2> undistort(Point2 distorted) const;

  /// Convert normalized coordinates behind the lens to pixels and back.
  Point2 to_pixel(Point2 distorted) const { return {fx * distorted.x + cx, fy * distorted.y + cy}; }
  Point2 from_pixel(Point2 pixel) const { return {(pixel.x - cx) / fx, (pixel.y - cy) / fy}; }

  friend bool operator==(const CameraModel&, const CameraModel&) = default;
};

/// Returns the lengths that a list of coefficients may have: 4, 5, 8, 12 or 14 for a pinhole, 4 for a
/// fisheye.
std::vector<std::size_t> distortion_counts(LensModel lens);

/// Sets the distortion of @p camera from coefficients in OpenCV's order. Pinhole: k1, k2, p1, p2, k3, k4, k5,
/// k6, s1, s2, s3, s4, tau_x, tau_y, or the first 4, 5, 8 or 12 of them; the others become 0. Fisheye
/// (`camera.lens`): k1, k2, k3, k4.
/// @throws std::invalid_argument if their number is not one of distortion_counts().
void set_distortion(CameraModel& camera, std::span<const double> coefficients);

/// Returns the coefficients in the same order: the first 5, 8, 12 or 14 of a pinhole, without trailing zeros
/// where possible; 4 of a fisheye.
std::vector<double> distortion_of(const CameraModel& camera);

}  // namespace stereod
