// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/visual/disparity_rendering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "daemon/imagefile/read_image.h"
#include "daemon/visual/color_map.h"
#include "daemon/visual/scale_bar.h"
#include "daemon/visual/tiny_font.h"

namespace stereod {
namespace {

/// Returns rows of disparities from @p first to @p last, one pixel each.
DisparityImage ramp(int first, int last, int height) {
  DisparityImage image(last - first + 1, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < image.width(); ++x) image.at(x, y) = static_cast<std::int16_t>(first + x);
  }
  return image;
}

std::vector<std::string> labels_of(const std::vector<ScaleTick>& ticks) {
  std::vector<std::string> labels;
  for (const ScaleTick& tick : ticks) labels.push_back(tick.label);
  return labels;
}

int saturation(Rgb color) {
  return std::max({color.r, color.g, color.b}) - std::min({color.r, color.g, color.b});
}

TEST(ColorMap, Nearer_BrighterAndWarmer) {
  int last = -1;
  for (int i = 0; i <= 64; ++i) {
    const Rgb color = nearness_color(i / 64.0);
    EXPECT_GT(gray_of(color), last) << i;
    last = gray_of(color);
  }
  EXPECT_GT(nearness_color(0).b, nearness_color(0).r);
  EXPECT_GT(nearness_color(1).r, nearness_color(1).b);
}

TEST(ColorMap, AnyNearness_DiffersFromUnmatched) {
  for (int i = 0; i <= 1000; ++i) EXPECT_GT(saturation(nearness_color(i / 1000.0)), 60);
  EXPECT_LT(saturation(kUnmatchedColor), 10);
}

TEST(ColorMap, OutOfRange_Clamped) {
  EXPECT_EQ(nearness_color(-3), nearness_color(0));
  EXPECT_EQ(nearness_color(7), nearness_color(1));
  EXPECT_EQ(nearness_color(std::numeric_limits<double>::quiet_NaN()), nearness_color(0));
  EXPECT_EQ(nearness_color(std::numeric_limits<double>::infinity()), nearness_color(1));
}

TEST(DisparityRendering, Range_ColorsByNearness) {
  DisparityImage disparity = ramp(0, 10, 1);
  disparity.at(4, 0) = kInvalidDisparity;
  DisparityRenderingOptions options;
  options.range = DisparityRange{2, 8};
  options.scale_bar = false;
  const ColorImage image = draw_disparity(disparity.view(), 1, options);
  ASSERT_EQ(image.size(), disparity.size());
  EXPECT_EQ(image.at(0, 0), nearness_color(0));
  EXPECT_EQ(image.at(2, 0), nearness_color(0));
  EXPECT_EQ(image.at(4, 0), kUnmatchedColor);
  EXPECT_EQ(image.at(5, 0), nearness_color(0.5));
  EXPECT_EQ(image.at(8, 0), nearness_color(1));
  EXPECT_EQ(image.at(10, 0), nearness_color(1));
}

TEST(DisparityRendering, SubpixelUnits_Scaled) {
  DisparityRenderingOptions options;
  options.range = DisparityRange{0, 1};
  options.scale_bar = false;
  const DisparityImage disparity = ramp(0, 16, 1);
  EXPECT_EQ(draw_disparity(disparity.view(), 16, options).at(8, 0), nearness_color(0.5));
}

TEST(DisparityRendering, ScaleBar_OnlyWidens) {
  const DisparityImage disparity = ramp(0, 99, 120);
  DisparityRenderingOptions options;
  options.range = DisparityRange{0, 99};
  const ColorImage with = draw_disparity(disparity.view(), 1, options);
  options.scale_bar = false;
  const ColorImage without = draw_disparity(disparity.view(), 1, options);
  EXPECT_GT(with.width(), without.width() + 20);
  EXPECT_EQ(with.height(), without.height());
  for (int y = 0; y < 120; ++y) {
    ASSERT_TRUE(std::equal(without.row(y), without.row(y) + 100, with.row(y))) << y;
  }
}

TEST(DisparityRendering, LowImage_NoScaleBar) {
  const DisparityImage low = ramp(0, 99, 59);
  EXPECT_EQ(draw_disparity(low.view(), 1, {}).size(), low.size());
}

TEST(DisparityRendering, NoMatch_Unmatched) {
  DisparityImage disparity(80, 60);
  for (int y = 0; y < 60; ++y) std::fill_n(disparity.row(y), 80, kInvalidDisparity);
  EXPECT_EQ(draw_disparity(disparity.view(), 16, {}).at(40, 30), kUnmatchedColor);
}

TEST(DisparityRendering, InvalidRangeOrScale_Throws) {
  const DisparityImage disparity = ramp(0, 9, 60);
  DisparityRenderingOptions options;
  for (const DisparityRange range :
       {DisparityRange{5, 5}, DisparityRange{6, 5},
        DisparityRange{0, std::numeric_limits<double>::infinity()}, DisparityRange{std::nan(""), 5}}) {
    options.range = range;
    EXPECT_THROW(draw_disparity(disparity.view(), 1, options), std::invalid_argument);
  }
  options.range = DisparityRange{0, 5};
  options.depth = DepthScale{0, 0};
  EXPECT_THROW(draw_disparity(disparity.view(), 1, options), std::invalid_argument);
}

TEST(TypicalRange, Outliers_ExcludedAndRounded) {
  // 1 % at 0, 1 % at 200, the rest evenly at 30…59: the outliers do not set the scale.
  DisparityImage disparity(100, 30);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 100; ++x) disparity.at(x, y) = static_cast<std::int16_t>(30 + y);
    disparity.at(0, y) = 0;
    disparity.at(1, y) = 200;
    disparity.at(2, y) = kInvalidDisparity;
  }
  EXPECT_EQ(typical_range(disparity.view(), 1), (DisparityRange{30, 60}));
  EXPECT_EQ(typical_range(disparity.view(), 10), (DisparityRange{3, 6}));
}

TEST(TypicalRange, AnyInput_NotEmpty) {
  DisparityImage disparity(4, 4);
  EXPECT_EQ(typical_range(disparity.view(), 1), (DisparityRange{0, 1})) << "all 0";
  for (int y = 0; y < 4; ++y) std::fill_n(disparity.row(y), 4, std::int16_t{7});
  EXPECT_EQ(typical_range(disparity.view(), 1), (DisparityRange{7, 8}));
  for (int y = 0; y < 4; ++y) std::fill_n(disparity.row(y), 4, kInvalidDisparity);
  EXPECT_EQ(typical_range(disparity.view(), 1), (DisparityRange{0, 1}));
}

TEST(ScaleBarTicks, Disparities_Round) {
  const std::vector<ScaleTick> ticks = disparity_ticks({3, 48}, 0.2);
  EXPECT_EQ(labels_of(ticks), (std::vector<std::string>{"10", "20", "30", "40"}));
  EXPECT_DOUBLE_EQ(ticks[0].nearness, 7.0 / 45);
  EXPECT_EQ(labels_of(disparity_ticks({0, 1}, 0.3)), (std::vector<std::string>{"0", "0.5", "1"}));
}

TEST(ScaleBarTicks, Depths_RoundAndPlaced) {
  // 100 px·m: 50 px is 2 m, 10 px is 10 m.
  const std::vector<ScaleTick> ticks = depth_ticks({10, 50}, {100, 0}, 0.1);
  for (const ScaleTick& tick : ticks) {
    EXPECT_NEAR(100 / std::stod(tick.label), 10 + 40 * tick.nearness, 1e-9) << tick.label;
    for (const ScaleTick& other : ticks) {
      if (&other != &tick) {
        EXPECT_GE(std::abs(other.nearness - tick.nearness), 0.1);
      }
    }
  }
  const std::vector<std::string> labels = labels_of(ticks);
  for (const char* round : {"2", "5", "10"}) {
    EXPECT_NE(std::find(labels.begin(), labels.end(), round), labels.end()) << round;
  }
}

TEST(ScaleBarTicks, DisparityOffset_Applied) {
  for (const ScaleTick& tick : depth_ticks({10, 50}, {100, 6}, 0.1)) {
    EXPECT_NEAR(100 / std::stod(tick.label), 10 + 40 * tick.nearness + 6, 1e-9) << tick.label;
  }
}

TEST(ScaleBarTicks, Steps_RoundedUp) {
  EXPECT_DOUBLE_EQ(round_step(1), 1);
  EXPECT_DOUBLE_EQ(round_step(1.01), 2);
  EXPECT_DOUBLE_EQ(round_step(3), 5);
  EXPECT_DOUBLE_EQ(round_step(0.06), 0.1);
  EXPECT_DOUBLE_EQ(round_step(700), 1000);
}

TEST(TinyFont, TextOutside_Clipped) {
  ColorImage image(20, 9);
  const Rgb white{255, 255, 255};
  draw_text(image.view(), 1, 1, "1", white, 1);
  int dots = 0;
  for (int y = 0; y < 9; ++y) dots += static_cast<int>(std::count(image.row(y), image.row(y) + 20, white));
  EXPECT_EQ(dots, 10);
  EXPECT_EQ(text_width("1", 1), 5);
  EXPECT_EQ(text_width("10", 2), 22);
  EXPECT_EQ(text_width("", 1), 0);
  draw_text(image.view(), -30, -4, "0123456789.-mpx ?", white, 5);  // for the address sanitizer
}

}  // namespace
}  // namespace stereod
