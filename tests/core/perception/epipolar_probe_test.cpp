// SPDX-License-Identifier: BSD-3-Clause
#include "core/perception/epipolar_probe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace stereod {
namespace {

constexpr Size kSize{320, 240};
constexpr double kDisparity = 17.3;

// Bumps of all sizes from 3 px up: texture everywhere, in both directions.
class Texture {
 public:
  Texture() : grid_(kGrid * kGrid) {
    std::mt19937 random(3);
    for (float& value : grid_) value = static_cast<float>(random() % 256);
  }
  double at(double x, double y) const {
    return 0.5 * octave(x / 3, y / 3) + 0.3 * octave(x / 7 + 50, y / 7) + 0.2 * octave(x / 20, y / 20 + 70);
  }

 private:
  static constexpr int kGrid = 256;
  double octave(double x, double y) const {
    const double fx = std::floor(x), fy = std::floor(y), u = x - fx, v = y - fy;
    const auto value = [&](int dx, int dy) {
      const int column = (static_cast<int>(fx) + dx) & (kGrid - 1),
                row = (static_cast<int>(fy) + dy) & (kGrid - 1);
      return static_cast<double>(grid_[static_cast<std::size_t>(row * kGrid + column)]);
    };
    return (1 - v) * ((1 - u) * value(0, 0) + u * value(1, 0)) +
           v * ((1 - u) * value(0, 1) + u * value(1, 1));
  }
  std::vector<float> grid_;
};

// The right image shows the left one shifted by kDisparity to the left and `down` rows down, darker and with
// less contrast.
template <typename Down>
void draw(GrayImage& left, GrayImage& right, Down down) {
  const Texture texture;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      left.at(x, y) = static_cast<std::uint8_t>(std::lround(texture.at(x, y)));
      right.at(x, y) =
          static_cast<std::uint8_t>(std::lround(0.7 * texture.at(x + kDisparity, y - down(x)) + 10));
    }
  }
}

struct Probed {
  std::vector<EpipolarMatch> matches;
  int absent = 0;
};

Probed probed(const GrayImage& left, const GrayImage& right, int frames = 100,
              EpipolarProbe::Reach reach = EpipolarProbe::Reach::kFar) {
  const Size size = left.size();
  const RectifyMap map = RectifyMap::identity({size, left.view().stride(), 1});
  const ValidityMask mask = map.mask();
  EpipolarProbe probe(size, 0, 48);
  Probed all;
  for (int frame = 0; frame < frames; ++frame) {
    std::array<EpipolarMatch, EpipolarProbe::kPatches> matches;
    const EpipolarProbe::Result result =
        probe.probe({map, mask, left.row(0)}, {map, mask, right.row(0)}, reach, matches);
    all.matches.insert(all.matches.end(), matches.begin(), matches.begin() + result.found);
    all.absent += result.absent;
  }
  return all;
}

TEST(EpipolarProbe, ShiftedRows_MeasuresError) {
  GrayImage left(kSize), right(kSize);
  for (const double down : {0.0, 0.4, -1.5, 3.0, -9.3}) {
    draw(left, right, [down](int) { return down; });
    const Probed all = probed(left, right);
    EXPECT_GT(all.matches.size(), 150U) << down;
    EXPECT_LT(all.absent, 30) << down;
    const auto found = epipolar_error(all.matches, kSize);
    ASSERT_TRUE(found.has_value()) << down;
    EXPECT_NEAR(found->row_offset_px, -down, 0.05);
    EXPECT_NEAR(found->epipolar_error_px, std::abs(down), 0.06);
    for (const EpipolarMatch& match : all.matches) {
      EXPECT_NEAR(match.row_offset_px, -down, 0.5);
      EXPECT_NEAR(match.disparity_px, kDisparity, 0.5);
    }
  }
}

// A near search finds the same matches; those beyond its reach are missed, not mismatched.
TEST(EpipolarProbe, NearReach_EqualsFarWithinReach) {
  GrayImage left(kSize), right(kSize);
  for (const double down : {0.0, 0.4, -1.2}) {
    draw(left, right, [down](int) { return down; });
    const Probed all = probed(left, right, 100, EpipolarProbe::Reach::kNear);
    EXPECT_GT(all.matches.size(), 150U) << down;
    EXPECT_LT(all.absent, 30) << down;
    const auto found = epipolar_error(all.matches, kSize);
    ASSERT_TRUE(found.has_value()) << down;
    EXPECT_NEAR(found->row_offset_px, -down, 0.05);
  }
  for (const double down : {3.0, -9.3}) {
    draw(left, right, [down](int) { return down; });
    const Probed all = probed(left, right, 100, EpipolarProbe::Reach::kNear);
    EXPECT_LT(all.matches.size(), 10U) << down;
    EXPECT_GT(all.absent, 100) << down;
  }
}

TEST(EpipolarProbe, TurnedCamera_ErrorDoesNotCancel) {
  GrayImage left(kSize), right(kSize);
  draw(left, right, [](int x) { return 0.02 * (x - kSize.width / 2); });  // 3 px at either side
  const auto found = epipolar_error(probed(left, right).matches, kSize);
  ASSERT_TRUE(found.has_value());
  EXPECT_GT(found->epipolar_error_px, 1.2);
  EXPECT_GT(found->epipolar_error_px,
            std::abs(found->row_offset_px) + 0.5);  // the common offset does not show it
}

TEST(EpipolarProbe, NothingSimilar_CountsAbsent) {
  GrayImage left(kSize), right(kSize);
  draw(left, right, [](int) { return 90.0; });
  const Probed beyond = probed(left, right);
  EXPECT_LT(beyond.matches.size(), 10U);
  EXPECT_GT(beyond.absent, 200);
  // A covered lens.
  for (int y = 0; y < kSize.height; ++y) std::fill_n(right.row(y), kSize.width, std::uint8_t{20});
  const Probed covered = probed(left, right);
  EXPECT_EQ(covered.matches.size(), 0U);
  EXPECT_GT(covered.absent, 200);
}

TEST(EpipolarProbe, Repetitive_FindsNothing) {
  GrayImage flat(kSize), stripes(kSize), checks(kSize);
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      flat.at(x, y) = static_cast<std::uint8_t>(100 + (x * 7 + y * 13) % 3);
      stripes.at(x, y) = static_cast<std::uint8_t>((x + y) / 9 % 2 * 150 + 40);  // endless along the stripes
      checks.at(x, y) = static_cast<std::uint8_t>((x / 7 + y / 7) % 2 * 150 + 40);
    }
  }
  for (const GrayImage* image : {&flat, &stripes, &checks}) {
    const Probed all = probed(*image, *image);
    EXPECT_EQ(all.matches.size(), 0U);
    EXPECT_EQ(all.absent, 0);
  }
}

TEST(EpipolarProbe, SmallImage_FindsNothing) {
  for (const Size size : {Size{1, 1}, Size{47, 100}, Size{100, 23}, Size{48, 24}, Size{50, 30}}) {
    GrayImage left(size), right(size);
    EXPECT_EQ(probed(left, right, 20).matches.size(), 0U);
  }
}

// Where the right image has no source nothing is found, although the zeros there are similar.
TEST(EpipolarProbe, NoSource_FindsNothing) {
  GrayImage left(kSize), right(kSize);
  draw(left, right, [](int) { return 0.0; });
  const RectifyMap map = RectifyMap::identity({kSize, left.view().stride(), 1});
  const ValidityMask mask = map.mask();
  const ValidityMask none(kSize, [](int, int) { return false; });
  EpipolarProbe probe(kSize, 0, 48);
  for (int frame = 0; frame < 50; ++frame) {
    const auto reach = frame % 2 == 0 ? EpipolarProbe::Reach::kNear : EpipolarProbe::Reach::kFar;
    std::array<EpipolarMatch, EpipolarProbe::kPatches> matches;
    EXPECT_EQ(probe.probe({map, mask, left.row(0)}, {map, none, right.row(0)}, reach, matches).found, 0);
    EXPECT_EQ(probe.probe({map, none, left.row(0)}, {map, mask, right.row(0)}, reach, matches).found, 0);
  }
}

TEST(EpipolarError, FewPointsAgree_IsClear) {
  std::vector<EpipolarMatch> matches;
  for (int i = 0; i < 11; ++i) matches.push_back({10, 10, i % 2 == 0 ? 4.0F : -4.0F, 5});  // a turned camera
  EXPECT_FALSE(clear_misalignment(matches).has_value());
  matches.push_back({10, 10, 0, 5});
  const auto found = clear_misalignment(matches);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->points, 12U);
  EXPECT_EQ(found->epipolar_error_px, 4);
  for (int i = 0; i < 2; ++i) matches.push_back({10, 10, 1.4F, 5});
  EXPECT_FALSE(clear_misalignment(matches).has_value()) << "11 of 14 are less than four fifths";
}

TEST(EpipolarError, TooFewPoints_ReturnsNullopt) {
  std::vector<EpipolarMatch> matches;
  for (int i = 0; i < 39; ++i) matches.push_back({10, 10, 1, 5});
  EXPECT_FALSE(epipolar_error(matches, kSize).has_value());
  matches.push_back({10, 10, 1, 5});
  const auto found = epipolar_error(matches, kSize);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->points, 40U);
  EXPECT_EQ(found->epipolar_error_px, 1);
  EXPECT_EQ(found->worst_part, 0);
}

}  // namespace
}  // namespace stereod
