// SPDX-License-Identifier: BSD-3-Clause
// The order of formats and rates.
#include "daemon/capture/v4l2/format_fallbacks.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace stereod::v4l2 {
namespace {

constexpr std::uint32_t kMjpeg = make_fourcc('M', 'J', 'P', 'G');
constexpr std::uint32_t kYuyv = make_fourcc('Y', 'U', 'Y', 'V');

/// Rates as a range, or as a list.
OfferedRates any_rate(double lowest, double fastest) { return {{fastest, lowest}, true}; }
OfferedRates rates(std::vector<double> listed) { return {std::move(listed), false}; }

TEST(FormatFallbacks, Auto_UncompressedMjpegLowerRates) {
  const std::vector<FormatRequest> fallbacks =
      format_fallbacks({{kMjpeg, any_rate(1, 30)}, {kYuyv, rates({30})}}, "auto", 30);
  ASSERT_EQ(fallbacks.size(), 4u);
  EXPECT_EQ(fallbacks[0].fourcc, kYuyv);
  EXPECT_EQ(fallbacks[1].fourcc, kMjpeg);
  EXPECT_EQ(fallbacks[1].fps, 30);
  EXPECT_EQ(fallbacks[2].fourcc, kMjpeg);
  EXPECT_EQ(fallbacks[2].fps, 15);
  EXPECT_EQ(fallbacks[3].fps, 7.5);
}

TEST(FormatFallbacks, SlowFormat_AfterFastOne) {
  EXPECT_EQ(format_fallbacks({{kYuyv, rates({10})}, {kMjpeg, rates({30})}}, "auto", 30)[0].fourcc, kMjpeg);
  EXPECT_EQ(
      format_fallbacks({{kYuyv, rates({30})}, {make_fourcc('G', 'R', 'E', 'Y'), rates({10})}}, "auto", 30)[0]
          .fourcc,
      kYuyv);
  const auto slow = format_fallbacks({{kYuyv, rates({10})}}, "auto", 30);
  EXPECT_EQ(slow[0].fourcc, kYuyv);
  EXPECT_EQ(slow[0].fps, 10);
}

TEST(FormatFallbacks, LessTraffic_First) {
  EXPECT_EQ(
      format_fallbacks({{kYuyv, rates({})}, {make_fourcc('N', 'V', '1', '2'), rates({})}}, "auto", 30)[0]
          .fourcc,
      make_fourcc('N', 'V', '1', '2'));
}

TEST(FormatFallbacks, UnknownFormat_Converted) {
  const auto fallbacks = format_fallbacks({{make_fourcc('P', '2', '0', '7'), rates({30, 15})}}, "auto", 30);
  ASSERT_EQ(fallbacks.size(), 2u) << "also at a lower rate, for a full bus";
  EXPECT_TRUE(fallbacks[0].convert);
  EXPECT_EQ(fallbacks[0].fps, 30);
  EXPECT_TRUE(fallbacks[1].convert);
  EXPECT_EQ(fallbacks[1].fps, 15);
  EXPECT_EQ(fallbacks[0].fourcc, make_fourcc('Y', 'U', '1', '2'));
}

TEST(FormatFallbacks, NamedFormat_NoAlternative) {
  const auto fallbacks = format_fallbacks({{kYuyv, rates({30})}, {kMjpeg, rates({30})}}, "mjpeg", 60);
  ASSERT_EQ(fallbacks.size(), 1u);
  EXPECT_EQ(fallbacks[0].fourcc, kMjpeg);
  EXPECT_EQ(fallbacks[0].fps, 30);
  EXPECT_TRUE(format_fallbacks({{kYuyv, rates({30})}}, "gray", 30).empty());
  EXPECT_TRUE(format_fallbacks({}, "auto", 30).empty());
}

TEST(FormatFallbacks, LowerRates_OnlyListedOnes) {
  std::vector<double> asked;
  for (const FormatRequest& step : format_fallbacks({{kMjpeg, rates({30, 25, 20, 15, 10, 5})}}, "auto", 30))
    asked.push_back(step.fps);
  EXPECT_EQ(asked, (std::vector<double>{30, 20, 10}));
  EXPECT_EQ(format_fallbacks({{kMjpeg, rates({30})}}, "auto", 30).size(), 1u) << "it has no other";
  EXPECT_EQ(format_fallbacks({{kMjpeg, any_rate(10, 30)}}, "auto", 30).size(), 2u)
      << "7.5 is out of its range";
}

TEST(FormatFallbacks, LowerRates_NotBelowFive) {
  const auto fallbacks = format_fallbacks({{kMjpeg, {}}}, "auto", 12);
  ASSERT_EQ(fallbacks.size(), 2u);
  EXPECT_EQ(fallbacks[1].fps, 6);
}

}  // namespace
}  // namespace stereod::v4l2
