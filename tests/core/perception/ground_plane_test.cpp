// SPDX-License-Identifier: BSD-3-Clause
#include "core/perception/ground_plane.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "tests/support/floor_world.h"
#include "tests/support/random_images.h"

namespace stereod {
namespace {

std::optional<GroundPlane> fitted(const ScanGeometry& camera, const DisparityImage& image) {
  GroundFit fit(camera);
  for (int y = 0; y < image.height(); ++y) fit.add_row(y, image.row(y));
  return fit.finish();
}

TEST(GroundFit, ObstaclesAndNoise_FindsPlane) {
  Random random(5);
  for (const double height : {0.15, 0.3, 0.8}) {
    for (const double pitch : {-0.05, 0.0, 0.2, 0.4}) {
      ScanGeometry camera = floor_camera();
      camera.disparity_offset = 1.5;
      DisparityImage image =
          floor_disparity(camera, {height, pitch}, {{1.0, 0.2, 0.1, 0, 0.5}, {2.0, -0.6, 0.3, 0, 1}});
      for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
          std::int16_t& value = image.at(x, y);
          if (random.one_in(10)) value = static_cast<std::int16_t>(random.between(-1, 900));
          if (value >= 4) value = static_cast<std::int16_t>(value + random.between(-4, 4));
        }
      }
      const auto plane = fitted(camera, image);
      ASSERT_TRUE(plane) << height << " " << pitch;
      EXPECT_NEAR(plane->height_m, height, 0.02 * height) << pitch;
      EXPECT_NEAR(plane->pitch_rad, pitch, 0.006) << height;
    }
  }
}

TEST(GroundFit, NoGround_ReturnsNullopt) {
  const ScanGeometry camera = floor_camera();
  DisparityImage image(camera.size);
  for (int y = 0; y < image.height(); ++y) std::fill_n(image.row(y), image.width(), kInvalidDisparity);
  EXPECT_FALSE(fitted(camera, image));  // no disparities
  for (int y = 0; y < image.height(); ++y) std::fill_n(image.row(y), image.width(), std::int16_t{320});
  EXPECT_FALSE(fitted(camera, image));  // a wall
  Random random(6);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x)
      image.at(x, y) = static_cast<std::int16_t>(random.between(-32768, 32767));
  }
  EXPECT_FALSE(fitted(camera, image));
}

}  // namespace
}  // namespace stereod
