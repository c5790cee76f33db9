// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/publish/pacer.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "daemon/base/clocks.h"

namespace stereod {
namespace {

constexpr double kBurstBytes = 96'000;  // fits a default socket buffer (212,992 B with its overhead)

}  // namespace

void Pacer::wait_to_send(std::size_t bytes) noexcept {
  if (ns_per_byte_ <= 0) return;
  const std::int64_t now = monotonic_ns();
  const auto burst_ns = static_cast<std::int64_t>(ns_per_byte_ * kBurstBytes);
  sent_until_ns_ = std::max(sent_until_ns_, now - burst_ns) +
                   static_cast<std::int64_t>(ns_per_byte_ * static_cast<double>(bytes));
  if (sent_until_ns_ > now) std::this_thread::sleep_for(std::chrono::nanoseconds(sent_until_ns_ - now));
}

}  // namespace stereod
