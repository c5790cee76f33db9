// A chessboard before two cameras of which everything is known.
#pragma once

#include <cstdint>
#include <vector>

#include "calib/base/pair_input.h"
#include "calib/board/board.h"
#include "calib/solve/pair_geometry.h"

namespace stereod {

/// Two ordinary cameras, not quite alike, 6 cm apart and a little turned to each other, with lenses of this
/// model.
StereoRigEstimate known_cameras(Size image, LensModel lens = LensModel::kPinhole);

/// Renders a board of dark and bright squares with a white border on gray ground, with smooth edges as a lens
/// makes them and a little noise.
class BoardScene {
 public:
  BoardScene(const StereoRigEstimate& cameras, const Board& board);

  /// The board in a pose for the left camera.
  ImagePair render(const BoardPose& in_left, std::uint64_t noise_seed) const;

 private:
  struct View {
    CameraModel camera;
    Image<float> ray_x, ray_y;  // (x, y, 1) of each pixel; NaN where the lens shows nothing
  };
  static View make_view(const CameraModel& camera);
  GrayImage render(const View& view, const BoardPose& pose, std::uint64_t noise_seed) const;

  StereoRigEstimate cameras_;
  Board board_;
  View left_, right_;
};

/// Images own their memory; a test that spoils one works on a copy.
GrayImage copy_of(const GrayImage& picture);
std::vector<ImagePair> copy_of(const std::vector<ImagePair>& pairs);

/// A board whose middle is at `middle` for the left camera, facing it, then turned by `turn` (a rotation
/// vector).
BoardPose board_at(const Board& board, const Vector3& middle, const Vector3& turn);

/// Poses that cover the image of known_cameras(): near and far, in all corners, tilted each way.
std::vector<BoardPose> varied_poses(const Board& board, int count);

}  // namespace stereod
