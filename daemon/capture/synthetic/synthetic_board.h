// A chessboard for rendered cameras, and where it is held to calibrate them.
#pragma once

#include <vector>

#include "core/geometry/camera_model.h"
#include "daemon/capture/synthetic/synthetic_world.h"

namespace stereod {

/// Dark and bright squares with a white border one square wide, told by the inner corners: those where four
/// squares meet.
struct BoardShape {
  int columns = 9, rows = 6;
  double square_m = 0.025;
};

/// The point (x, y, 0) of a board, whose first inner corner is the origin, is at rotation·(x, y, 0) +
/// origin_m for a camera.
struct BoardPlace {
  Matrix3 rotation;
  Vector3 origin_m;
};

/// A board whose middle is at `middle_m`, facing the camera, then turned by `turn` (a rotation vector).
BoardPlace board_place(const BoardShape& shape, const Vector3& middle_m, const Vector3& turn);

/// Places that show all that is to be calibrated: near and far, in all parts of the image, tilted each way.
/// The cameras stand `baseline_m` apart and see x/z and y/z up to `half_width` and `half_height`; the whole
/// board is in sight of both.
std::vector<BoardPlace> varied_places(const BoardShape& shape, double half_width, double half_height,
                                      double baseline_m, int count);

/// A board at its place, seen through a camera.
class SyntheticBoard {
 public:
  /// `focal_px`: the camera's; edges are as soft as its lens and its pixels make them.
  SyntheticBoard(const BoardShape& shape, const BoardPlace& place, double focal_px);

  /// The nearer of `behind` and what the ray meets of the board.
  SceneHit hit(const SceneRay& ray, SceneHit behind) const;

 private:
  BoardShape shape_;
  Matrix3 to_board_;
  Vector3 origin_m_;
  double focal_px_;
};

}  // namespace stereod
