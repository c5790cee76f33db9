// SPDX-License-Identifier: BSD-3-Clause
// Disparities of the rendered scene, computed as the daemon does.
#pragma once

#include "core/geometry/depth.h"
#include "core/match/frame_matcher.h"
#include "core/perception/obstacle_scan.h"
#include "core/rectify/rectify_map.h"
#include "daemon/capture/synthetic/synthetic_scene.h"

namespace stereod {

/// Renders, rectifies and matches frames of a scene, as the daemon does.
class SceneMatcher {
 public:
  explicit SceneMatcher(const SyntheticScene& scene, int threads = 2)
      : scene_(scene),
        pool_(threads),
        options_(*matcher_preset("robust")),
        left_map_(scene.calibration().left, layout(scene.size())),
        right_map_(scene.calibration().right, layout(scene.size())),
        left_mask_(left_map_.mask()),
        right_mask_(right_map_.mask()),
        matcher_(options_, scene.size(), pool_),
        left_(scene.size()),
        right_(scene.size()),
        disparity_(scene.size()) {
    matcher_.use_masks(&left_mask_, &right_mask_);
  }

  /// Renders and rectifies frame @p frame.
  void load(int frame) {
    rectify(scene_.render_left(frame), left_map_, left_);
    rectify(scene_.render_right(frame), right_map_, right_);
  }
  /// Matches the loaded frame.
  void rematch() { matcher_.match(left_.view(), right_.view(), disparity_.view()); }
  const DisparityImage& disparity() const { return disparity_; }

  const DisparityImage& match(int frame) {
    load(frame);
    rematch();
    return disparity_;
  }

  ScanGeometry camera() const {
    const Calibration& calibration = scene_.calibration();
    const RectifiedProjection& p = calibration.left.projection;
    ScanGeometry camera;
    camera.size = scene_.size();
    camera.fx = p.fx, camera.fy = p.fy, camera.cx = p.cx, camera.cy = p.cy;
    camera.baseline_m = calibration.baseline_m;
    camera.disparity_offset = disparity_offset_px(calibration);
    camera.units_per_pixel = options_.units_per_pixel();
    camera.min_disparity = options_.min_disparity;
    camera.disparities = options_.disparities;
    return camera;
  }

 private:
  static SourceLayout layout(Size size) { return {size, GrayImage(size).view().stride(), 1}; }
  static void rectify(const GrayImage& raw, const RectifyMap& map, GrayImage& out) {
    for (int y = 0; y < out.height(); ++y) map.gray_row(raw.row(0), y, out.row(y));
  }

  const SyntheticScene& scene_;
  WorkerPool pool_;
  MatcherOptions options_;
  RectifyMap left_map_, right_map_;
  ValidityMask left_mask_, right_mask_;
  FrameMatcher matcher_;
  GrayImage left_, right_;
  DisparityImage disparity_;
};

}  // namespace stereod
