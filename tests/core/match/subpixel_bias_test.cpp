// SPDX-License-Identifier: BSD-3-Clause
// The interpolation is not biased to whole numbers: a textured plane of known disparity is swept through
// fractions of a pixel.
//
// Source of the bounds (tests/bench/subpixel_sweep, no noise / 4 gray levels): the maximum mean error at any
// fraction is below 0.015 / 0.012 px, and 6.8 / 5.6 % of the disparities are whole numbers (ideal: 1/16 =
// 6.25 %). A parabola through the same costs has 0.10 / 0.08 px and 12.8 / 10.8 %, and fails here.
#include <gtest/gtest.h>

#include <cmath>

#include "core/match/frame_matcher.h"
#include "tests/support/matcher_cases.h"
#include "tests/support/subpixel_bias.h"

namespace stereod {
namespace {

constexpr double kMaxMeanError = 0.03;  // [px]
constexpr double kMinShare = 0.045;     // of the disparities, at each sixteenth of a pixel
constexpr double kMaxShare = 0.08;

SubpixelBias bias_with(Prefilter prefilter, double noise) {
  SubpixelSweep sweep;
  sweep.pixels = 1;
  sweep.noise = noise;
  MatcherOptions options;
  options.disparities = 32;
  options.prefilter = prefilter;
  FrameMatcher matcher(options, sweep.size, pool_of(1));
  return sweep_plane(sweep, [&](const StereoPair& pair) {
    DisparityImage found(sweep.size);
    matcher.match(pair.left.view(), pair.right.view(), found.view());
    return found;
  });
}

void expect_unbiased(const SubpixelBias& bias) {
  EXPECT_GT(bias.answered, 0.99);
  for (std::size_t i = 0; i < bias.mean_error.size(); ++i) {
    EXPECT_LT(std::fabs(bias.mean_error[i]), kMaxMeanError) << "at " << i << "/32 px";
  }
  for (std::size_t i = 0; i < bias.share.size(); ++i) {
    EXPECT_GT(bias.share[i], kMinShare) << "at " << i << "/16 px";
    EXPECT_LT(bias.share[i], kMaxShare) << "at " << i << "/16 px";
  }
}

TEST(SubpixelBias, Gradients_Small) { expect_unbiased(bias_with(Prefilter::kXsobel, 0)); }

TEST(SubpixelBias, NoisyGradients_Small) { expect_unbiased(bias_with(Prefilter::kXsobel, 4)); }

TEST(SubpixelBias, GrayValues_Small) { expect_unbiased(bias_with(Prefilter::kNone, 0)); }

}  // namespace
}  // namespace stereod
