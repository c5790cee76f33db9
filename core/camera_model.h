// A camera with a lens: from a direction to a pixel and back.
#pragma once

#include <array>
#include <optional>

#include "core/image.h"

namespace stereod {

/// A point of a plane: pixels, or normalised image coordinates (x/z, y/z).
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

/// A 3×3 matrix, row by row. The default is the identity.
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

/// The rotation by |v| radians about the direction of `v` (Rodrigues' formula).
Matrix3 rotation_about(const Vector3& v);

/// A pinhole camera behind a lens with rational radial and tangential distortion: the model and the names of
/// OpenCV (docs.opencv.org, calib3d; Brown 1966, Claus and Fitzgibbon 2005), without the thin prism. Pixel
/// (0, 0) is the centre of the top left pixel. All distortion 0 is a plain pinhole.
struct CameraModel {
  Size image;
  double fx = 0, fy = 0;          ///< focal lengths in pixels
  double cx = 0, cy = 0;          ///< principal point in pixels
  double k1 = 0, k2 = 0;          ///< radial, numerator
  double p1 = 0, p2 = 0;          ///< tangential
  double k3 = 0;                  ///< radial, numerator
  double k4 = 0, k5 = 0, k6 = 0;  ///< radial, denominator

  /// Normalised coordinates without the lens to those behind it.
  Point2 distort(Point2 undistorted) const;

  /// The inverse of distort(), by Newton's method to 1e-12; nothing where it does not converge, as for points
  /// farther out than the model can bend a ray. Close to the image centre it always does for a real lens.
  std::optional<Point2> undistort(Point2 distorted) const;

  Point2 to_pixel(Point2 distorted) const { return {fx * distorted.x + cx, fy * distorted.y + cy}; }
  Point2 from_pixel(Point2 pixel) const { return {(pixel.x - cx) / fx, (pixel.y - cy) / fy}; }

  friend bool operator==(const CameraModel&, const CameraModel&) = default;
};

}  // namespace stereod
