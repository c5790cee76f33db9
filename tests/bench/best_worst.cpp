// SPDX-License-Identifier: BSD-3-Clause
// Draws the sets on which the presets do best, middling and worst, by bad-1 over all known pixels: ground
// truth, OpenCV's BM and SGBM 3WAY, fast, dense and robust, each with its stats. For the documentation.
//   best_worst IMAGE.png
// Or scenes of a rig, DIRECTORY/left_SCENE.png and right_SCENE.png, by its calibration (rig_scenes.h):
//   best_worst IMAGE.png CALIBRATION.yaml DIRECTORY SCENE...
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>

#include "daemon/tools/match/evaluation.h"
#include "daemon/visual/disparity_rendering.h"
#include "tests/bench/bench_images.h"
#include "tests/bench/panels.h"
#include "tests/bench/quality_matchers.h"
#include "tests/bench/rig_scenes.h"
#include "tests/bench/stereo_sets.h"

namespace stereod::bench {

using tools::evaluate;
using tools::Evaluation;
namespace {

std::vector<QualityMatcher> contestants() {
  return {padded(opencv_bm()), padded(opencv_sgbm_3way(10)),
          own_matcher("fast", matcher_preset("fast").value()),
          own_matcher("dense", matcher_preset("dense").value()),
          own_matcher("robust", matcher_preset("robust").value())};
}

Evaluation judge(const QualityMatcher& matcher, const StereoSet& set, const DisparityImage& found) {
  return evaluate(found.view(), matcher.units_per_pixel, set.truth.view(), 1);
}

/// Returns the sets with the minimum, the median and the maximum of the mean of dense's and robust's bad-1
/// over all known pixels.
std::array<const StereoSet*, 3> best_to_worst(const std::vector<StereoSet>& sets) {
  std::vector<std::pair<double, const StereoSet*>> ranked;
  for (const StereoSet& set : sets) {
    double bad = 0;
    for (const char* preset : {"dense", "robust"}) {
      const QualityMatcher matcher = own_matcher(preset, matcher_preset(preset).value());
      bad += judge(matcher, set, matcher.match(set, set.disparities)).bad1_known / 2;
    }
    ranked.emplace_back(bad, &set);
  }
  std::sort(ranked.begin(), ranked.end());
  return {ranked.front().second, ranked[ranked.size() / 2].second, ranked.back().second};
}

DisparityImage disparity_of(const Image<float>& truth) {
  DisparityImage disparity(truth.size());
  for (int y = 0; y < truth.height(); ++y) {
    for (int x = 0; x < truth.width(); ++x) {
      const float value = truth.at(x, y);
      disparity.at(x, y) = std::isfinite(value)
                               ? static_cast<std::int16_t>(std::lround(value * kSubpixelUnits))
                               : kInvalidDisparity;
    }
  }
  return disparity;
}

cv::Mat row_of(const StereoSet& set) {
  const DisparityImage truth = disparity_of(set.truth);
  const DisparityRange range = typical_range(truth.view(), kSubpixelUnits);
  std::vector<cv::Mat> panels{panel(truth, kSubpixelUnits, range, {set.name, "ground truth"})};
  for (const QualityMatcher& matcher : contestants()) {
    const DisparityImage found = matcher.match(set, set.disparities);
    const Evaluation stats = judge(matcher, set, found);
    std::array<char, 80> bad{};
    std::array<char, 80> rest{};
    std::snprintf(bad.data(), bad.size(), "%s: bad %.1f%%", matcher.name.c_str(), stats.bad1_known);
    std::snprintf(rest.data(), rest.size(), "of matched %.1f%%, matched %.1f%%", stats.bad1_matched,
                  stats.density);
    panels.push_back(panel(found, matcher.units_per_pixel, range, {bad.data(), rest.data()}));
    std::printf("%-14s %s, %s\n", set.name.c_str(), bad.data(), rest.data());
  }
  return row_of_panels(panels);
}

std::vector<cv::Mat> set_rows() {
  const StereoSets found = load_stereo_sets({});
  for (const std::string& missing : found.missing) std::printf("%s\n", missing.c_str());
  if (found.sets.empty()) throw std::runtime_error("there are no sets to draw");
  std::vector<cv::Mat> rows;
  for (const StereoSet* set : best_to_worst(found.sets)) rows.push_back(row_of(*set));
  return rows;
}

}  // namespace
}  // namespace stereod::bench

int main(int argc, char** argv) {
  using namespace stereod::bench;
  try {
    if (argc == 2) {
      write_rows(argv[1], set_rows());
    } else if (argc > 4) {
      write_rows(argv[1], rig_scene_rows(argv[2], argv[3], {argv + 4, argv + argc}));
    } else {
      throw std::invalid_argument("usage: best_worst IMAGE.png [CALIBRATION.yaml DIRECTORY SCENE...]");
    }
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "best_worst: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
