#include "tests/bench/quality_matchers.h"

#include <opencv2/calib3d.hpp>

#include "core/match/frame_matcher.h"
#include "tests/bench/bench_images.h"

namespace stereod::bench {
namespace {

constexpr int kWindow = 11;

/// OpenCV's answer in our own image with our own word for unmatched.
DisparityImage compute(cv::StereoMatcher& matcher, const StereoSet& set) {
  cv::Mat found;
  matcher.compute(set.left, set.right, found);
  DisparityImage result(found.cols, found.rows);
  for (int y = 0; y < result.height(); ++y) {
    for (int x = 0; x < result.width(); ++x) {
      const std::int16_t value = found.at<std::int16_t>(y, x);
      result.at(x, y) = value < 0 ? kInvalidDisparity : value;
    }
  }
  return result;
}

std::string in_words(const MatcherOptions& o) {
  const auto number = [](const char* name, int value) {
    return ", " + std::string(name) + " " + std::to_string(value);
  };
  return "window " + std::to_string(o.window) + ", prefilter " + std::string(name_of(o.prefilter)) +
         (o.prefilter == Prefilter::kNone ? "" : number("prefilter_cap", o.prefilter_cap)) +
         number("texture_threshold", o.texture_threshold) + number("uniqueness_ratio", o.uniqueness_ratio) +
         number("left_right_max_diff", o.left_right_max_diff) + number("subpixel", o.subpixel ? 1 : 0) +
         number("median", o.median) + number("speckle_size", o.speckle_size) +
         number("speckle_max_diff", o.speckle_max_diff);
}

}  // namespace

QualityMatcher opencv_bm() {
  return {"BM", "OpenCV StereoBM, block 11, defaults", kSubpixelUnits,
          [](const StereoSet& set, int disparities) {
            return compute(*cv::StereoBM::create(disparities, kWindow), set);
          }};
}

QualityMatcher opencv_bm_without_tests() {
  return {"BM, tests off", "OpenCV StereoBM, block 11, uniqueness, texture, speckle and left-right test off",
          kSubpixelUnits, [](const StereoSet& set, int disparities) {
            const cv::Ptr<cv::StereoBM> bm = cv::StereoBM::create(disparities, kWindow);
            bm->setUniquenessRatio(0);
            bm->setTextureThreshold(0);
            bm->setSpeckleWindowSize(0);
            bm->setDisp12MaxDiff(-1);
            return compute(*bm, set);
          }};
}

QualityMatcher opencv_sgbm_3way() {
  constexpr int kBlock = 5;
  constexpr int kP1 =
      8 * kBlock * kBlock;  // P1 and P2 as OpenCV's own example has them, the rest its defaults
  constexpr int kP2 = 32 * kBlock * kBlock;
  return {"SGBM 3WAY", "OpenCV StereoSGBM 3WAY, block 5, P1 200, P2 800, else defaults", kSubpixelUnits,
          [](const StereoSet& set, int disparities) {
            const cv::Ptr<cv::StereoSGBM> sgbm = cv::StereoSGBM::create(0, disparities, kBlock, kP1, kP2);
            sgbm->setMode(cv::StereoSGBM::MODE_SGBM_3WAY);
            return compute(*sgbm, set);
          }};
}

QualityMatcher own_matcher(const std::string& name, const MatcherOptions& options) {
  return {
      name, in_words(options), options.units_per_pixel(), [options](const StereoSet& set, int disparities) {
        MatcherOptions adapted = options;
        adapted.disparities = disparities;
        WorkerPool pool(1);
        DisparityImage found(view_of(set.left).size());
        FrameMatcher(adapted, found.size(), pool).match(view_of(set.left), view_of(set.right), found.view());
        return found;
      }};
}

}  // namespace stereod::bench
