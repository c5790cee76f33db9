// SPDX-License-Identifier: BSD-3-Clause
// A rendered scene with two imperfect cameras and exact ground truth.
#pragma once

#include <cstdint>

#include "core/base/image.h"
#include "core/geometry/calibration.h"
#include "core/rectify/rectify_map.h"
#include "daemon/capture/synthetic/synthetic_board.h"
#include "daemon/capture/synthetic/synthetic_world.h"

namespace stereod {

/// Renders SyntheticWorld through two cameras like inexpensive webcams: different focal lengths and principal
/// points, lens distortion, slightly rotated optical axes, a darker right camera, noise. The same arguments
/// give the same images on every run.
class SyntheticScene {
 public:
  /// @p size [px, ≥ 64×48]: focal lengths and disparities grow with it; at 640×480 disparities are 6…55 px.
  /// @p frames [≥ 1]: length of a seamless loop. @p baseline_m [m, > 0]. @p boxes: false shows only floor and
  /// wall.
  /// @throws std::invalid_argument if an argument is out of range.
  explicit SyntheticScene(Size size = {640, 480}, int frames = 24, double baseline_m = 0.06,
                          bool boxes = true);

  Size size() const { return calibration_.image; }
  int frames() const { return frames_; }

  /// Returns the exact parameters, which a perfect calibration would find.
  const Calibration& calibration() const { return calibration_; }

  /// Renders frame @p frame [≥ 0] of a camera; numbers continue past the end of the loop. Any number of
  /// threads at once.
  /// @p board: an additional board, posed in the frame of the rectified left camera; may be null.
  GrayImage render_left(int frame, const SyntheticBoard* board = nullptr) const {
    return render(left_, frame, board);
  }
  GrayImage render_right(int frame, const SyntheticBoard* board = nullptr) const {
    return render(right_, frame, board);
  }

  /// Returns the true disparity [px] of each pixel of the rectified left image, NaN outside the left camera's
  /// view.
  Image<float> ground_truth(int frame) const;

  /// Returns 1 for each pixel of the rectified left image whose point is also visible in the rectified right
  /// image, 0 if it is occluded or outside.
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
    Image<Direction> rays;  // through the camera's own, distorted pixels
    Image<SceneHit> still;  // the static part of the scene along those rays
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
