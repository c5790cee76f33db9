// SPDX-License-Identifier: BSD-3-Clause
// A message bus that keeps the messages of one channel.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "daemon/lcm/message_bus.h"
#include "daemon/lcm/message_decoder.h"
#include "stereod/frame_t.hpp"

namespace stereod {

/// Keeps the messages of one channel, and the frame summaries on T_FRAME. A message that cannot be decoded
/// fails the test.
template <typename Message>
class KeepingBus final : public MessageBus {
 public:
  explicit KeepingBus(std::string channel) : channel_(std::move(channel)) {}

  bool publish(const char* channel, const void* data, std::size_t size) noexcept override {
    const std::lock_guard lock(mutex_);
    if (channel_ == channel) keep(messages_, data, size);
    if (std::string("T_FRAME") == channel) keep(frames_, data, size);
    return true;
  }
  std::vector<Message> messages() {
    const std::lock_guard lock(mutex_);
    return messages_;
  }
  std::vector<frame_t> frames() {
    const std::lock_guard lock(mutex_);
    return frames_;
  }

 private:
  template <typename Kept>
  static void keep(std::vector<Kept>& all, const void* data, std::size_t size) {
    EXPECT_TRUE(decode_message({static_cast<const std::byte*>(data), size}, all.emplace_back()));
  }

  const std::string channel_;
  std::mutex mutex_;
  std::vector<Message> messages_;
  std::vector<frame_t> frames_;
};

}  // namespace stereod
