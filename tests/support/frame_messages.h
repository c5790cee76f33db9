// SPDX-License-Identifier: BSD-3-Clause
// Messages as the daemon sends them, for frames of 12 × 10 pixels, and someone who puts them together again.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "daemon/client/stereod_client.h"

namespace stereod {

inline constexpr int kWidth = 12;
inline constexpr int kHeight = 10;
inline constexpr int kRowsPerMessage = 2;

inline std::int64_t utime_of(std::int64_t frame) {
  return 1'700'000'000'000'000 + frame % 1'000'000 * 33'333;
}

/// The wire value of a pixel in these tests: another for each frame, row and column, sometimes invalid.
inline int value_at(std::int64_t frame, int x, int y) {
  const int value = static_cast<int>((frame % 1000 * 31 + std::int64_t{y} * 17 + std::int64_t{x} * 5) % 1000);
  return value % 7 == 0 ? 65535 : value;
}

/// Rows as the daemon sends them.
inline disparity_rows_t rows_of(std::int64_t frame, int first_row, int count = kRowsPerMessage) {
  disparity_rows_t m{};
  m.utime = utime_of(frame);
  m.frame = frame;
  m.width = kWidth;
  m.height = kHeight;
  m.first_row = first_row;
  m.row_count = count;
  m.decimation_x = m.decimation_y = 1;
  m.disparities = 64;
  m.scale = 0.0625F;
  m.bytes_per_value = 2;
  m.invalid = 65535;
  for (int y = first_row; y < first_row + count; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int value = value_at(frame, x, y);
      m.data.push_back(static_cast<std::uint8_t>(value & 0xFF));
      m.data.push_back(static_cast<std::uint8_t>(value >> 8));
    }
  }
  m.size = static_cast<std::int32_t>(m.data.size());
  return m;
}

/// Marks pixels of a message as filled; `is_filled(x, y)` is asked for each.
template <typename IsFilled>
void mark_filled(disparity_rows_t& m, IsFilled is_filled) {
  const int row_bytes = (m.width + 7) / 8;
  m.filled_size = row_bytes * m.row_count;
  m.filled.assign(static_cast<std::size_t>(m.filled_size), 0);
  for (int row = 0; row < m.row_count; ++row) {
    for (int x = 0; x < m.width; ++x) {
      std::uint8_t& byte = m.filled[static_cast<std::size_t>(row * row_bytes + x / 8)];
      if (is_filled(x, m.first_row + row)) byte = static_cast<std::uint8_t>(byte | 1U << (x % 8));
    }
  }
}

/// The message after a frame's last row.
inline frame_t summary_of(std::int64_t frame) {
  frame_t m{};
  m.utime = utime_of(frame);
  m.frame = frame;
  m.width = kWidth;
  m.height = kHeight;
  m.rows = kHeight;
  m.messages = kHeight / kRowsPerMessage;
  m.measured_fraction = 0.5F;
  return m;
}

/// A calibrated camera: depth is 50 m / disparity in px.
inline camera_info_t camera_info_of() {
  camera_info_t m{};
  m.width = kWidth;
  m.height = kHeight;
  m.calibrated = 1;
  m.fx = m.fy = 500;
  m.cx = 6;
  m.cy = 5;
  m.baseline_m = 0.1;
  m.disparities = 64;
  m.calibration_id = "1";
  return m;
}

using Message = std::variant<disparity_rows_t, frame_t>;

/// All messages of a frame, in the daemon's order.
inline std::vector<Message> messages_of(std::int64_t frame) {
  std::vector<Message> messages;
  for (int y = 0; y < kHeight; y += kRowsPerMessage) messages.emplace_back(rows_of(frame, y));
  messages.emplace_back(summary_of(frame));
  return messages;
}

/// An assembler and what it handed over.
struct AssemblerFixture {
  std::vector<StereoFrame> frames;
  FrameAssembler assembler{[this](StereoFrame&& frame) { frames.push_back(std::move(frame)); }};

  void take(const Message& message) {
    std::visit([this](const auto& m) { assembler.take(m); }, message);
  }
  void take_all(const std::vector<Message>& messages) {
    for (const Message& message : messages) take(message);
  }
  void take_frame(std::int64_t frame) { take_all(messages_of(frame)); }
  const ReceptionCounts& counts() const { return assembler.counts(); }
};

/// Every pixel is what was sent, or invalid where its row did not arrive.
inline void expect_pixels(const StereoFrame& frame) {
  ASSERT_EQ(frame.disparity.width(), kWidth);
  ASSERT_EQ(frame.disparity.height(), kHeight);
  ASSERT_EQ(frame.row_present.size(), static_cast<std::size_t>(kHeight));
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int sent = value_at(frame.frame, x, y);
      const bool valid = sent != 65535 && frame.row_present[static_cast<std::size_t>(y)];
      EXPECT_EQ(frame.disparity.at(x, y), valid ? sent : DisparityMap::kNone)
          << "frame " << frame.frame << " " << y;
    }
  }
}

/// The counts add up.
inline void expect_sums(const ReceptionCounts& c) {
  EXPECT_EQ(c.frames_expected, c.frames_complete + c.frames_incomplete + c.frames_missing);
  EXPECT_EQ(c.rows_expected, c.rows_received + c.rows_lost);
  EXPECT_GE(std::min({c.frames_expected, c.frames_complete, c.frames_incomplete, c.frames_missing}), 0);
  EXPECT_GE(std::min({c.rows_expected, c.rows_received, c.rows_lost, c.rows_duplicate}), 0);
}

}  // namespace stereod
