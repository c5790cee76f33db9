// SPDX-License-Identifier: BSD-3-Clause
#include "calib/live/daemon_feed.h"

#include <algorithm>

namespace stereod::calib {

DaemonFeed::DaemonFeed(const std::string& lcm_url, const std::string& prefix) : receiver_(lcm_url) {
  receiver_.subscribe(prefix + "_LEFT_RAW", [this](auto message) { pairing_.add(Side::kLeft, message); });
  receiver_.subscribe(prefix + "_RIGHT_RAW", [this](auto message) { pairing_.add(Side::kRight, message); });
}

// A consumer that is slower than the daemon would otherwise work through a growing queue of old images.
void DaemonFeed::read_waiting_messages() {
  // Bounds the work where messages arrive faster than they are decoded.
  constexpr int kMaxMessages = 2 * LcmReceiver::kQueueCapacity;
  for (int i = 0; i < kMaxMessages && receiver_.receive(std::chrono::milliseconds(0)); ++i) {
  }
}

std::optional<ImagePair> DaemonFeed::next(std::chrono::milliseconds timeout) {
  using std::chrono::steady_clock;
  const auto deadline = steady_clock::now() + timeout;
  for (;;) {
    read_waiting_messages();
    if (auto pair = pairing_.take()) {
      ++taken_;
      pair->name = "pair " + std::to_string(taken_);
      return pair;
    }
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - steady_clock::now());
    if (left.count() <= 0) return std::nullopt;
    receiver_.receive(left);
  }
}

}  // namespace stereod::calib
