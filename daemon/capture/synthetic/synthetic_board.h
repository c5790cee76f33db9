// SPDX-License-Identifier: BSD-3-Clause
// A chessboard for rendered cameras, and the places at which it is shown to calibrate them.
#pragma once

#include <vector>

#include "core/geometry/camera_model.h"
#include "daemon/capture/synthetic/synthetic_world.h"

namespace stereod {

/// A board of dark and bright squares with a white border one square wide. Columns and rows count the inner
/// corners, where four squares meet.
struct BoardShape {
  int columns = 9, rows = 6;
  double square_m = 0.025;
};

/// The pose of a board: its point (x, y, 0), with the first inner corner as origin, lies at rotation·(x, y,
/// 0) + origin_m in the camera's frame.
struct BoardPlace {
  Matrix3 rotation;
  Vector3 origin_m;
};

/// Returns the pose of a board with its center at @p middle_m, facing the camera, then rotated by @p turn
/// (rotation vector).
BoardPlace board_place(const BoardShape& shape, const Vector3& middle_m, const Vector3& turn);

/// Returns @p count poses for a complete calibration: near and far, in all parts of the image, tilted in all
/// directions. The cameras are @p baseline_m apart and see |x/z| ≤ @p half_width and |y/z| ≤ @p half_height.
/// Both cameras see the whole board at every pose.
std::vector<BoardPlace> varied_places(const BoardShape& shape, double half_width, double half_height,
                                      double baseline_m, int count);

/// A board at its pose, as rays meet it.
class SyntheticBoard {
 public:
  /// @p focal_px: focal length of the camera [px]; edges are blurred over two of its pixels.
  SyntheticBoard(const BoardShape& shape, const BoardPlace& place, double focal_px);

  /// Returns the nearer one of @p behind and the point at which the ray meets the board.
  SceneHit hit(const SceneRay& ray, SceneHit behind) const;

 private:
  BoardShape shape_;
  Matrix3 to_board_;
  Vector3 origin_m_;
  double focal_px_;
};

}  // namespace stereod
