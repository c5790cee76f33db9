// SPDX-License-Identifier: BSD-3-Clause
// The contestants of depth_quality: stereod's presets and OpenCV's matchers.
#include "tests/bench/quality_matchers.h"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <utility>

#include "core/match/frame_matcher.h"
#include "tests/bench/bench_images.h"

namespace stereod::bench {
namespace {

constexpr int kWindow = 11;

/// Copies OpenCV's disparities, with our value for unmatched pixels.
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
  if (o.method == Method::kSemiglobal) {
    return "semi-global, grid " + std::string(name_of(o.grid)) + number("p1", o.p1) + number("p2", o.p2) +
           number("census_weight", o.census_weight) + number("gradient_limit", o.gradient_limit) +
           number("prefilter_cap", o.prefilter_cap) + number("uniqueness_ratio", o.uniqueness_ratio) +
           number("left_right_max_diff", o.left_right_max_diff) + number("median", o.median) +
           number("speckle_size", o.speckle_size) + (o.hole_filling ? ", filled" : "");
  }
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

QualityMatcher opencv_sgbm_3way(int uniqueness_ratio) {
  constexpr int kBlock = 5, kCap = 31;
  return {"SGBM 3WAY u" + std::to_string(uniqueness_ratio),
          "OpenCV StereoSGBM 3WAY, block 5, P1 200, P2 800, cap 31, uniqueness " +
              std::to_string(uniqueness_ratio),
          kSubpixelUnits, [=](const StereoSet& set, int disparities) {
            return compute(
                *cv::StereoSGBM::create(0, disparities, kBlock, 8 * kBlock * kBlock, 32 * kBlock * kBlock, 0,
                                        kCap, uniqueness_ratio, 0, 0, cv::StereoSGBM::MODE_SGBM_3WAY),
                set);
          }};
}

QualityMatcher padded(QualityMatcher matcher) {
  matcher.settings += ", padded at the left";
  matcher.match = [match = std::move(matcher.match)](const StereoSet& set, int disparities) {
    StereoSet wider{set.name, {}, {}, {}, disparities};
    cv::copyMakeBorder(set.left, wider.left, 0, 0, disparities, 0, cv::BORDER_REPLICATE);
    cv::copyMakeBorder(set.right, wider.right, 0, 0, disparities, 0, cv::BORDER_REPLICATE);
    const DisparityImage wide = match(wider, disparities);
    DisparityImage found(view_of(set.left).size());
    for (int y = 0; y < found.height(); ++y) {
      std::copy_n(wide.row(y) + disparities, found.width(), found.row(y));
    }
    return found;
  };
  return matcher;
}

QualityMatcher as_dense_as(QualityMatcher reference, QualityMatcher sparse, QualityMatcher dense) {
  const std::string name = sparse.name + " at its density";
  const std::string settings =
      sparse.name + ", filled up with pixels of " + dense.name + " to the density of " + reference.name;
  const int units = sparse.units_per_pixel;
  const auto match = [=](const StereoSet& set, int disparities) {
    const auto matched = [&](const DisparityImage& image) {
      long count = 0;
      for (int y = 0; y < image.height(); ++y) {
        count += std::count_if(image.row(y), image.row(y) + image.width(),
                               [](std::int16_t value) { return value >= 0; });
      }
      return count;
    };
    DisparityImage found = sparse.match(set, disparities);
    const DisparityImage more = dense.match(set, disparities);
    const long has = matched(found), wanted = matched(reference.match(set, disparities));
    const long others = matched(more) - has, needed = std::clamp(wanted - has, 0L, std::max(others, 0L));
    long due = 0;  // needed / others of a pixel with each one passed
    for (int y = 0; y < found.height(); ++y) {
      for (int x = 0; x < found.width(); ++x) {
        if (found.at(x, y) >= 0 || more.at(x, y) < 0) continue;
        due += needed;
        if (due >= others) due -= others, found.at(x, y) = more.at(x, y);
      }
    }
    return found;
  };
  return {name, settings, units, match};
}

QualityMatcher own_matcher(const std::string& name, const MatcherOptions& options) {
  return {
      name, in_words(options), options.units_per_pixel(), [options](const StereoSet& set, int disparities) {
        MatcherOptions adapted = options;
        adapted.disparities = disparities;
        WorkerPool pool(1);
        DisparityImage found(view_of(set.left).size());
        FrameMatcher(adapted, found.size(), pool).match(view_of(set.left), view_of(set.right), found.view());
        for (int y = 0; y < found.height(); ++y) {
          for (int x = 0; x < found.width(); ++x) {
            std::int16_t& value = found.at(x, y);
            if (is_filled(value)) value = filled_disparity(value);
          }
        }
        return found;
      }};
}

}  // namespace stereod::bench
