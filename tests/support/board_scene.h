// SPDX-License-Identifier: BSD-3-Clause
// Renders a chessboard seen by two cameras with known parameters.
#pragma once

#include <cstdint>
#include <vector>

#include "calib/base/pair_input.h"
#include "calib/board/board.h"
#include "calib/solve/pair_geometry.h"

namespace stereod::calib {

/// Returns two slightly different webcams, 6 cm apart and slightly rotated relative to each other, with lenses of
/// model @p lens.
StereoRigEstimate known_cameras(Size image, LensModel lens = LensModel::kPinhole);

/// Renders a chessboard with a white border on a gray background, with smooth edges and noise.
class BoardScene {
 public:
  BoardScene(const StereoRigEstimate& cameras, const Board& board);

  /// Renders both images. @p in_left is the board's pose for the left camera.
  ImagePair render(const BoardPose& in_left, std::uint64_t noise_seed) const;

 private:
  struct View {
    CameraModel camera;
    Image<float> ray_x, ray_y;  // ray (x, y, 1) of each pixel; NaN where the lens has none
  };
  static View make_view(const CameraModel& camera);
  GrayImage render(const View& view, const BoardPose& pose, std::uint64_t noise_seed) const;

  StereoRigEstimate cameras_;
  Board board_;
  View left_, right_;
};

/// Returns a deep copy, for a test that modifies images.
GrayImage copy_of(const GrayImage& image);
std::vector<ImagePair> copy_of(const std::vector<ImagePair>& pairs);

/// Returns the pose of a board with its center at @p middle for the left camera, facing it, then rotated by @p turn
/// (a rotation vector).
BoardPose board_at(const Board& board, const Vector3& middle, const Vector3& turn);

/// Returns poses that cover the image of known_cameras(): near and far, in all corners, tilted in every direction.
std::vector<BoardPose> varied_poses(const Board& board, int count);

/// Returns the exact corners of a board at @p pose in the image of @p camera.
Corners projected_corners(const CameraModel& camera, const Board& board, const BoardPose& pose);

}  // namespace stereod::calib
