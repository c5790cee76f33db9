// Draws the sets on which the presets do best, middling and worst, by bad-1 over all known pixels: ground
// truth, OpenCV's BM and SGBM 3WAY, fast, dense and robust, each with its figures. For the documentation.
//   best_worst PICTURE.png
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "daemon/imagefile/disparity_picture.h"
#include "daemon/tools/evaluation.h"
#include "tests/bench/bench_images.h"
#include "tests/bench/quality_matchers.h"
#include "tests/bench/stereo_sets.h"

namespace stereod::bench {
namespace {

constexpr int kPanelWidth = 240;
constexpr int kGap = 6;
constexpr int kCaption = 34;  // two lines

std::vector<QualityMatcher> contestants() {
  return {opencv_bm(), opencv_sgbm_3way(), own_matcher("fast", matcher_preset("fast").value()),
          own_matcher("dense", matcher_preset("dense").value()),
          own_matcher("robust", matcher_preset("robust").value())};
}

Evaluation judge(const QualityMatcher& matcher, const StereoSet& set, const DisparityImage& found) {
  return evaluate(found.view(), matcher.units_per_pixel, set.truth.view(), 1);
}

/// The sets on which the mean of dense's and robust's bad-1 over all known pixels is least, the median, and
/// greatest.
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

cv::Mat panel(const DisparityImage& disparity, int units_per_pixel, DisparityRange range,
              const std::string& first_line, const std::string& second_line) {
  DisparityPictureOptions options;
  options.range = range;
  options.scale_bar = false;
  ColorImage colors = draw_disparity(disparity.view(), units_per_pixel, options);
  const cv::Mat whole(colors.height(), colors.width(), CV_8UC3, colors.row(0),
                      static_cast<std::size_t>(colors.view().stride()));
  cv::Mat scaled;
  const int height = static_cast<int>(std::lround(1.0 * kPanelWidth * whole.rows / whole.cols));
  cv::resize(whole, scaled, {kPanelWidth, height}, 0, 0, cv::INTER_NEAREST);
  cv::Mat captioned(height + kCaption, kPanelWidth, CV_8UC3, cv::Scalar::all(255));
  cv::cvtColor(scaled, captioned.rowRange(kCaption, captioned.rows), cv::COLOR_RGB2BGR);
  const cv::Scalar ink = cv::Scalar::all(40);
  cv::putText(captioned, first_line, {2, 12}, cv::FONT_HERSHEY_SIMPLEX, 0.42, ink, 1, cv::LINE_AA);
  cv::putText(captioned, second_line, {2, 28}, cv::FONT_HERSHEY_SIMPLEX, 0.36, ink, 1, cv::LINE_AA);
  return captioned;
}

cv::Mat row_of(const StereoSet& set) {
  const DisparityImage truth = disparity_of(set.truth);
  const DisparityRange range = typical_range(truth.view(), kSubpixelUnits);
  std::vector<cv::Mat> panels{panel(truth, kSubpixelUnits, range, set.name, "ground truth")};
  for (const QualityMatcher& matcher : contestants()) {
    const DisparityImage found = matcher.match(set, set.disparities);
    const Evaluation figures = judge(matcher, set, found);
    std::array<char, 80> bad{};
    std::array<char, 80> rest{};
    std::snprintf(bad.data(), bad.size(), "%s: bad %.1f%%", matcher.name.c_str(), figures.bad1_known);
    std::snprintf(rest.data(), rest.size(), "of matched %.1f%%, matched %.1f%%", figures.bad1_matched,
                  figures.density);
    panels.push_back(panel(found, matcher.units_per_pixel, range, bad.data(), rest.data()));
    std::printf("%-14s %s, %s\n", set.name.c_str(), bad.data(), rest.data());
  }
  cv::Mat row(panels.front().rows, static_cast<int>(panels.size()) * (kPanelWidth + kGap) - kGap, CV_8UC3,
              cv::Scalar::all(255));
  for (std::size_t i = 0; i < panels.size(); ++i) {
    panels[i].copyTo(row(cv::Rect(static_cast<int>(i) * (kPanelWidth + kGap), 0, kPanelWidth, row.rows)));
  }
  return row;
}

void run(const std::string& path) {
  const StereoSets found = load_stereo_sets({});
  for (const std::string& missing : found.missing) std::printf("%s\n", missing.c_str());
  if (found.sets.empty()) throw std::runtime_error("there are no sets to draw");
  std::vector<cv::Mat> rows;
  for (const StereoSet* set : best_to_worst(found.sets)) rows.push_back(row_of(*set));
  cv::Mat picture;
  cv::vconcat(rows, picture);
  if (!cv::imwrite(path, picture, {cv::IMWRITE_PNG_COMPRESSION, 9})) {
    throw std::runtime_error(path + ": cannot be written");
  }
}

}  // namespace
}  // namespace stereod::bench

int main(int argc, char** argv) {
  try {
    if (argc != 2) throw std::invalid_argument("usage: best_worst PICTURE.png");
    stereod::bench::run(argv[1]);
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "best_worst: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
