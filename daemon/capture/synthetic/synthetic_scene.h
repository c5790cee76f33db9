// A rendered scene with two flawed cameras, of which everything is known exactly.
#pragma once

#include <cstdint>

#include "core/base/image.h"
#include "core/geometry/calibration.h"
#include "core/rectify/rectify_map.h"
#include "daemon/capture/synthetic/synthetic_board.h"
#include "daemon/capture/synthetic/synthetic_world.h"

namespace stereod {

/// The world of SyntheticWorld through two cameras as they come: focal lengths and principal points differ,
/// the lenses distort, neither looks quite straight ahead, the right one exposes less, both are noisy. The
/// same arguments give the same images on every run.
class SyntheticScene {
 public:
  /// Frames `frames` ≥ 1 make a loop without seam. `size` from 64×48 up; focal lengths and so disparities
  /// grow with it: at 640×480 these are 6…55 px. `baseline_m` > 0. `boxes`: false leaves floor and wall
  /// alone. Throws std::invalid_argument.
  explicit SyntheticScene(Size size = {640, 480}, int frames = 24, double baseline_m = 0.06,
                          bool boxes = true);

  Size size() const { return calibration_.image; }
  int frames() const { return frames_; }

  /// Exact, not estimated: what a perfect calibration of these cameras would find.
  const Calibration& calibration() const { return calibration_; }

  /// What the cameras see in a frame ≥ 0, counted on past the end of the loop. Any number of threads at once.
  /// `board`: stands before all else, its place told for the rectified left camera; nullptr: none.
  GrayImage render_left(int frame, const SyntheticBoard* board = nullptr) const {
    return render(left_, frame, board);
  }
  GrayImage render_right(int frame, const SyntheticBoard* board = nullptr) const {
    return render(right_, frame, board);
  }

  /// The true disparity, in pixels and fractions, of each pixel of the rectified left image; NaN where the
  /// left camera did not look.
  Image<float> ground_truth(int frame) const;

  /// 1 for each pixel of the rectified left image whose point the rectified right image shows too, else 0:
  /// hidden behind something nearer or beyond the border.
  Image<std::uint8_t> visible_in_right(int frame) const;

 private:
  struct Direction {
    float x, y;  // of the ray (x, y, 1) in the rectified frame
  };
  struct View {
    float origin_x;
    float gain, black_level;  // the exposure
    std::uint64_t noise_seed;
    RectifyMap map;
    Image<Direction> rays;  // of the camera's own, distorted pixels
    Image<SceneHit> still;  // what never moves, seen along them
  };

  View make_view(const CameraCalibration& camera, double origin_x, float gain, float black_level,
                 std::uint64_t noise_seed) const;
  SceneRay rectified_ray(const View& view, float x, float y) const;
  GrayImage render(const View& view, int frame, const SyntheticBoard* board) const;

  int frames_;
  Calibration calibration_;
  SyntheticWorld world_;
  View left_;
  View right_;
};

}  // namespace stereod
