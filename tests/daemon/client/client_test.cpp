// SPDX-License-Identifier: BSD-3-Clause
// The client library with valid and invalid messages. frame_assembler_test.cpp tests the assembly of frames.
#include "daemon/client/stereod_client.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/support/frame_messages.h"

namespace stereod {
namespace {

template <typename Message>
std::vector<std::uint8_t> encoded(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  EXPECT_GT(message.encode(bytes.data(), 0, static_cast<int>(bytes.size())), 0);
  return bytes;
}

class Client : public testing::Test {
 protected:
  Client() {
    client_->on_frame([this](StereoFrame&& frame) { frames_.push_back(std::move(frame)); });
  }

  void take(const Message& message) {
    if (const auto* rows = std::get_if<disparity_rows_t>(&message)) {
      const auto bytes = encoded(*rows);
      client_->take_rows(bytes.data(), bytes.size());
    } else {
      const auto bytes = encoded(std::get<frame_t>(message));
      client_->take_frame(bytes.data(), bytes.size());
    }
  }
  void take_frame(std::int64_t frame) {
    for (const Message& message : messages_of(frame)) take(message);
  }
  void take(const camera_info_t& info) {
    const auto bytes = encoded(info);
    client_->take_camera_info(bytes.data(), bytes.size());
  }

  std::unique_ptr<StereoClient> client_ = StereoClient::unconnected();
  std::vector<StereoFrame> frames_;
};

TEST_F(Client, CompleteFrame_GivesDisparityDepthAndPoints) {
  camera_info_t info = camera_info_of();
  info.disparity_offset = 2;
  take(info);
  take_frame(1);
  ASSERT_EQ(frames_.size(), 1U);
  const StereoFrame& frame = frames_[0];
  ASSERT_TRUE(frame.complete());
  const std::vector<float> depths = frame.depths_m();
  ASSERT_EQ(depths.size(), static_cast<std::size_t>(kWidth * kHeight));
  std::size_t valid = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int value = value_at(1, x, y);
      const float depth = depths[static_cast<std::size_t>(y * kWidth + x)];
      if (value == 65535) {
        EXPECT_TRUE(std::isnan(frame.disparity_px(x, y)));
        EXPECT_TRUE(std::isnan(depth));
        EXPECT_TRUE(std::isnan(frame.point(x, y).x));
        continue;
      }
      ++valid;
      const double z = 500 * 0.1 / (value / 16.0 + 2);
      EXPECT_FLOAT_EQ(frame.disparity_px(x, y), static_cast<float>(value) / 16);
      EXPECT_FLOAT_EQ(depth, static_cast<float>(z));
      EXPECT_FLOAT_EQ(frame.point(x, y).x, static_cast<float>((x - 6) * z / 500));
      EXPECT_FLOAT_EQ(frame.point(x, y).y, static_cast<float>((y - 5) * z / 500));
      EXPECT_FLOAT_EQ(frame.point(x, y).z, static_cast<float>(z));
    }
  }
  EXPECT_EQ(frame.points().size(), valid);
  EXPECT_LT(frame.points(3).size(), valid / 4);
}

TEST_F(Client, DecimatedRegion_MapsToRectifiedPixels) {
  take(camera_info_of());
  for (Message message : messages_of(1)) {
    if (auto* rows = std::get_if<disparity_rows_t>(&message)) {
      rows->left = 100;
      rows->top = 50;
      rows->decimation_x = 2;
      rows->decimation_y = 3;
    }
    take(message);
  }
  ASSERT_EQ(frames_.size(), 1U);
  const StereoFrame& frame = frames_[0];
  EXPECT_EQ(frame.grid, (PixelGrid{100, 50, 2, 3}));
  const double z = 500 * 0.1 / (value_at(1, 4, 7) / 16.0);
  EXPECT_FLOAT_EQ(frame.depth_m(4, 7), static_cast<float>(z))
      << "disparities are in px of the rectified image";
  EXPECT_FLOAT_EQ(frame.point(4, 7).x, static_cast<float>((100 + 4 * 2 - 6) * z / 500));
  EXPECT_FLOAT_EQ(frame.point(4, 7).y, static_cast<float>((50 + 7 * 3 - 5) * z / 500));
}

TEST_F(Client, FilledPixels_OnlyOnRequest) {
  const auto filled = [](int x, int y) { return (x + y) % 3 == 0; };
  client_->on_rows([&](const RowBlock& block) {
    std::vector<std::int16_t> measured(kWidth), all(kWidth);
    for (int y = block.message().first_row; y < block.message().first_row + kRowsPerMessage; ++y) {
      block.copy_row(y, measured.data());
      block.copy_row(y, all.data(), Pixels::kMeasuredOrFilled);
      for (int x = 0; x < kWidth; ++x) {
        const int sent = value_at(1, x, y) == 65535 ? DisparityMap::kNone : value_at(1, x, y);
        EXPECT_EQ(all[static_cast<std::size_t>(x)], sent);
        EXPECT_EQ(measured[static_cast<std::size_t>(x)], filled(x, y) ? DisparityMap::kNone : sent);
        EXPECT_EQ(block.is_filled(x, y), filled(x, y));
      }
    }
  });
  take(camera_info_of());
  for (Message message : messages_of(1)) {
    if (auto* rows = std::get_if<disparity_rows_t>(&message)) mark_filled(*rows, filled);
    take(message);
  }
  ASSERT_EQ(frames_.size(), 1U);
  const StereoFrame& frame = frames_[0];
  std::size_t measured = 0, all = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int value = value_at(1, x, y);
      const bool is_measured = value != 65535 && !filled(x, y);
      measured += is_measured ? 1 : 0;
      all += value != 65535 ? 1 : 0;
      EXPECT_EQ(frame.disparity.at(x, y), is_measured ? value : DisparityMap::kNone);
      EXPECT_EQ(std::isnan(frame.depth_m(x, y)), !is_measured);
      if (value == 65535) continue;
      EXPECT_FLOAT_EQ(frame.disparity_px(x, y, Pixels::kMeasuredOrFilled), static_cast<float>(value) / 16);
      EXPECT_FLOAT_EQ(frame.point(x, y, Pixels::kMeasuredOrFilled).z,
                      static_cast<float>(50 / (value / 16.0)));
    }
  }
  EXPECT_EQ(frame.points().size(), measured);
  EXPECT_EQ(frame.points(1, Pixels::kMeasuredOrFilled).size(), all);
  EXPECT_LT(measured, all);
  client_->on_rows(nullptr);
  take_frame(2);
  EXPECT_EQ(frames_[1].filled.width(), 0) << "nothing was filled";
}

TEST_F(Client, NoCameraInfo_NoDepth) {
  take_frame(1);
  ASSERT_EQ(frames_.size(), 1U);
  EXPECT_FALSE(frames_[0].camera);
  EXPECT_FALSE(std::isnan(frames_[0].disparity_px(1, 0)));
  EXPECT_TRUE(std::isnan(frames_[0].depth_m(1, 0)));
  EXPECT_TRUE(frames_[0].points().empty());
  take(camera_info_of());
  take_frame(2);
  EXPECT_TRUE(frames_[1].camera);
  camera_info_t uncalibrated = camera_info_of();
  uncalibrated.calibrated = 0;
  take(uncalibrated);
  take_frame(3);
  EXPECT_FALSE(frames_[2].camera);
}

TEST_F(Client, Horizon_InfiniteDepthNoPoint) {
  const CameraGeometry camera = *geometry_of(camera_info_of());
  EXPECT_EQ(camera.depth_m(0), std::numeric_limits<double>::infinity());
  EXPECT_EQ(camera.depth_m(-1), std::numeric_limits<double>::infinity());
  StereoFrame frame;
  frame.disparity = DisparityMap(1, 1);
  frame.disparity.row(0)[0] = 0;
  frame.camera = camera;
  EXPECT_EQ(frame.depth_m(0, 0), std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::isnan(frame.point(0, 0).z));
  EXPECT_TRUE(frame.points().empty());
}

TEST_F(Client, InvalidCameraInfo_NoGeometry) {
  const auto refused = [](auto change) {
    camera_info_t info = camera_info_of();
    change(info);
    return !geometry_of(info);
  };
  ASSERT_FALSE(refused([](auto&) {}));
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refused([](auto& m) { m.fx = 0; }));
  EXPECT_TRUE(refused([](auto& m) { m.fy = -1; }));
  EXPECT_TRUE(refused([](auto& m) { m.baseline_m = 0; }));
  EXPECT_TRUE(refused([](auto& m) { m.baseline_m = INFINITY; }));
  EXPECT_TRUE(refused([](auto& m) { m.cx = kNan; }));
  EXPECT_TRUE(refused([](auto& m) { m.cy = kNan; }));
  EXPECT_TRUE(refused([](auto& m) { m.disparity_offset = kNan; }));
}

TEST_F(Client, Rows_HandedOverInOrderOfArrival) {
  std::vector<int> first_rows;
  client_->on_rows([&](const RowBlock& block) {
    const disparity_rows_t& m = block.message();
    first_rows.push_back(m.first_row);
    std::vector<std::int16_t> row(kWidth);
    for (int y = m.first_row; y < m.first_row + m.row_count; ++y) {
      block.copy_row(y, row.data());
      for (int x = 0; x < kWidth; ++x) {
        const int sent = value_at(m.frame, x, y);
        const int want = sent == 65535 ? DisparityMap::kNone : sent;
        ASSERT_EQ(block.at(x, y), want);
        ASSERT_EQ(row[static_cast<std::size_t>(x)], want);
      }
    }
    EXPECT_EQ(block.units_per_pixel(), 16);
  });
  take(rows_of(1, 4));
  take(rows_of(1, 0));
  EXPECT_EQ(first_rows, (std::vector<int>{4, 0}));
  disparity_rows_t bad = rows_of(1, 2);
  bad.row_count = 5;  // its data has two rows
  take(Message(bad));
  EXPECT_EQ(first_rows.size(), 2U);
  EXPECT_EQ(client_->counts().messages_ignored, 1);
  EXPECT_TRUE(frames_.empty());
}

TEST_F(Client, MalformedBytes_CountedAsIgnored) {
  const std::vector<std::uint8_t> rubbish(100, 0x5A);
  client_->take_rows(rubbish.data(), rubbish.size());
  client_->take_frame(rubbish.data(), 0);
  client_->take_camera_info(rubbish.data(), 7);
  std::vector<std::uint8_t> rows = encoded(rows_of(0, 0));
  client_->take_frame(rows.data(), rows.size());  // valid, but on the wrong channel
  rows.pop_back();
  client_->take_rows(rows.data(), rows.size());
  EXPECT_EQ(client_->counts().messages_ignored, 5);
  take_frame(1);
  EXPECT_EQ(frames_.size(), 1U);
}

TEST_F(Client, Counts_DescribedInSentences) {
  for (int i = 0; i < 4; ++i) take_frame(i);
  EXPECT_EQ(describe_problems(client_->counts()), "");
  ReceptionCounts counts;
  counts.restarts = 3;
  EXPECT_NE(describe_problems(counts).find("two of them publish on the same channels"), std::string::npos);
  counts = {};
  counts.messages_ignored = 2;
  EXPECT_NE(describe_problems(counts).find("another program"), std::string::npos);
  counts = {};
  counts.rows_expected = 480;
  counts.rows_lost = 16;
  EXPECT_NE(describe_problems(counts).find("16 of 480 rows were lost"), std::string::npos);
}

TEST(ClientConnection, InvalidUrlOrPrefix_Throws) {
  StereoClient::Options options;
  options.url = "nonsense";
  EXPECT_THROW(StereoClient{options}, std::runtime_error);
  options.url = "memq://";
  options.prefix = std::string(60, 'P');
  EXPECT_THROW(StereoClient{options}, std::runtime_error);
  options.prefix = "";
  EXPECT_THROW(StereoClient{options}, std::runtime_error);
}

void publish(lcm_t* lcm, const char* channel, const std::vector<std::uint8_t>& bytes) {
  lcm_publish(lcm, channel, bytes.data(), static_cast<unsigned int>(bytes.size()));
}

TEST(ClientConnection, ForeignLcm_HandlesFrames) {
  lcm_t* lcm = lcm_create("memq://");
  {
    StereoClient client(lcm, "A.B");
    int frames = 0;
    client.on_frame([&](StereoFrame&& frame) { frames += frame.complete() && frame.camera ? 1 : 0; });
    publish(lcm, "A.B_CAMERA_INFO", encoded(camera_info_of()));
    publish(lcm, "AxB_DISPARITY", encoded(rows_of(0, 0)));  // the prefix is a name, not a pattern
    for (int y = 0; y < kHeight; y += kRowsPerMessage) publish(lcm, "A.B_DISPARITY", encoded(rows_of(3, y)));
    publish(lcm, "A.B_FRAME", encoded(summary_of(3)));
    for (int i = 0; i < 2 + kHeight / kRowsPerMessage; ++i) ASSERT_GT(lcm_handle_timeout(lcm, 1000), 0);
    EXPECT_EQ(frames, 1);
    EXPECT_EQ(client.counts().messages_ignored, 0);
  }
  publish(lcm, "A.B_FRAME", encoded(summary_of(3)));  // the client is destroyed: no handler is called
  EXPECT_EQ(lcm_handle_timeout(lcm, 0), 0);
  lcm_destroy(lcm);
}

}  // namespace
}  // namespace stereod
