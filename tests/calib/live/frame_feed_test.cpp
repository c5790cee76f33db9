// SPDX-License-Identifier: BSD-3-Clause
// Live pairs from the cameras of a configuration.
#include "calib/live/frame_feed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <thread>

#include "daemon/base/file.h"
#include "daemon/imagefile/write_image.h"
#include "tests/support/temporary_directory.h"

namespace stereod::calib {
namespace {

using std::chrono::milliseconds;

constexpr int kPairs = 7;

// Writes pairs whose pixels have the value of the pair's number.
void write_numbered_pairs(const TemporaryDirectory& directory) {
  for (int i = 0; i < kPairs; ++i) {
    GrayImage image(32, 24);
    for (int y = 0; y < image.height(); ++y)
      std::fill_n(image.row(y), image.width(), static_cast<std::uint8_t>(i));
    image.at(0, 0) = 100;
    write_png(directory / ("left_" + std::to_string(i) + ".png"), image.view());
    image.at(0, 0) = 200;
    write_png(directory / ("right_" + std::to_string(i) + ".png"), image.view());
  }
}

Config replay_config(const TemporaryDirectory& directory, const std::string& settings) {
  write_text_file(directory / "config.yaml",
                  "cameras:\n  source: replay\n  replay: {directory: ., loop: false}\n  " + settings + "\n");
  return read_config(directory / "config.yaml");
}

TEST(CameraFeed, FpsZero_LosesNoPair) {
  const TemporaryDirectory directory;
  write_numbered_pairs(directory);
  CameraFeed feed(replay_config(directory, "fps: 0"));
  for (int i = 0; i < kPairs; ++i) {
    const auto pair = feed.next(milliseconds(10'000));
    ASSERT_TRUE(pair.has_value()) << i;
    EXPECT_EQ(pair->left.at(5, 5), i);
    EXPECT_EQ(pair->right.at(5, 5), i);
    EXPECT_EQ(pair->left.at(0, 0), 100);
    EXPECT_EQ(pair->right.at(0, 0), 200);
    std::this_thread::sleep_for(milliseconds(20));  // a consumer slower than the source
  }
  EXPECT_FALSE(feed.next(milliseconds(10'000)).has_value());
  EXPECT_TRUE(feed.finished());
}

TEST(CameraFeed, SlowSource_TimesOut) {
  const TemporaryDirectory directory;
  write_numbered_pairs(directory);
  CameraFeed feed(replay_config(directory, "fps: 1"));
  ASSERT_TRUE(feed.next(milliseconds(10'000)).has_value());
  EXPECT_FALSE(feed.next(milliseconds(1)).has_value());
  EXPECT_FALSE(feed.finished());
}

}  // namespace
}  // namespace stereod::calib
