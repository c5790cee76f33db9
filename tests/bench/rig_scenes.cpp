// SPDX-License-Identifier: BSD-3-Clause
// Rectifying, matching and drawing the scenes of a rig.
#include "tests/bench/rig_scenes.h"

#include <array>
#include <cstdio>

#include "core/match/frame_matcher.h"
#include "core/rectify/rectify_map.h"
#include "daemon/base/file_error.h"
#include "daemon/config/calibration_file.h"
#include "daemon/imagefile/read_image.h"
#include "tests/bench/bench_images.h"
#include "tests/bench/panels.h"
#include "tests/bench/quality_matchers.h"

namespace stereod::bench {
namespace {

constexpr int kDisparities = 64;

struct View {
  cv::Mat image;
  ValidityMask mask;
};

View rectified(const CameraCalibration& camera, const std::filesystem::path& file) {
  const GrayImage seen = read_gray(file);
  if (seen.size() != camera.camera.image) {
    throw FileError(file.string() + ": is " + std::to_string(seen.width()) + "x" +
                    std::to_string(seen.height()) + " px, but the calibration is for " +
                    std::to_string(camera.camera.image.width) + "x" +
                    std::to_string(camera.camera.image.height));
  }
  const RectifyMap map(camera, {seen.size(), seen.view().stride(), 1}, Interpolation::kBilinear);
  View view{cv::Mat(seen.height(), seen.width(), CV_8UC1), map.mask()};
  map.gray_rows(seen.row(0), {0, seen.height()},
                {view.image.data, seen.width(), seen.height(), static_cast<std::ptrdiff_t>(view.image.step)});
  return view;
}

/// Matches as the daemon does: with masks of the pixels outside the cameras' views.
DisparityImage matched(const MatcherOptions& options, const View& left, const View& right) {
  WorkerPool pool(1);
  DisparityImage found(view_of(left.image).size());
  FrameMatcher matcher(options, found.size(), pool);
  matcher.use_masks(&left.mask, &right.mask);
  matcher.match(view_of(left.image), view_of(right.image), found.view());
  return found;
}

/// Prepares @p found for drawing and returns the share of matched pixels [%]: filled ones count as measured,
/// and all are rounded to whole pixels, which nearly halves the file. Pixels outside the camera's view are
/// removed from every result and from the share.
double shown(DisparityImage& found, const ValidityMask& mask) {
  int seen = 0, answered = 0;
  for (int y = 0; y < found.height(); ++y) {
    for (int x = 0; x < found.width(); ++x) {
      std::int16_t& value = found.at(x, y);
      if (mask.row(y)[x] == 0) {
        value = kInvalidDisparity;
        continue;
      }
      if (is_filled(value)) value = filled_disparity(value);
      ++seen;
      if (value < 0) continue;
      ++answered;
      value = static_cast<std::int16_t>((value + kSubpixelUnits / 2) / kSubpixelUnits * kSubpixelUnits);
    }
  }
  return 100.0 * answered / seen;
}

cv::Mat row_of(const Calibration& calibration, const std::filesystem::path& directory,
               const std::string& scene) {
  const View left = rectified(calibration.left, directory / ("left_" + scene + ".png"));
  const View right = rectified(calibration.right, directory / ("right_" + scene + ".png"));
  const StereoSet set{scene, left.image, right.image, {}, kDisparities};
  std::vector<std::pair<std::string, DisparityImage>> answers;
  for (const QualityMatcher& matcher : {opencv_bm(), padded(opencv_sgbm_3way(10))}) {
    answers.emplace_back(matcher.name, matcher.match(set, kDisparities));
  }
  for (const char* name : {"dense", "robust", "fine"}) {
    MatcherOptions options = matcher_preset(name).value();
    options.disparities = kDisparities;
    answers.emplace_back(name, matched(options, left, right));
  }
  const DisparityRange range = typical_range(answers.back().second.view(), kSubpixelUnits);
  std::vector<cv::Mat> panels;
  for (auto& [name, found] : answers) {
    std::array<char, 40> share{};
    std::snprintf(share.data(), share.size(), "%.1f%% answered", shown(found, left.mask));
    panels.push_back(panel(found, kSubpixelUnits, range, {scene + ": " + name, share.data()}));
    std::printf("scene %s: %s %s\n", scene.c_str(), name.c_str(), share.data());
  }
  return row_of_panels(panels);
}

}  // namespace

std::vector<cv::Mat> rig_scene_rows(const std::filesystem::path& calibration,
                                    const std::filesystem::path& directory,
                                    const std::vector<std::string>& scenes) {
  const Calibration rig = read_calibration(calibration);
  std::vector<cv::Mat> rows;
  for (const std::string& scene : scenes) rows.push_back(row_of(rig, directory, scene));
  return rows;
}

}  // namespace stereod::bench
