// SPDX-License-Identifier: BSD-3-Clause
// Reads the two clocks of the daemon.
#pragma once

#include <chrono>
#include <cstdint>

namespace stereod {

/// Returns CLOCK_MONOTONIC [ns], the clock of everything inside the daemon.
inline std::int64_t monotonic_ns() noexcept {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// Returns the time since the Unix epoch [µs], the clock of messages.
inline std::int64_t wall_us() noexcept {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// Converts a time of the monotonic clock [ns] to a time since the Unix epoch [µs].
inline std::int64_t wall_us_of(std::int64_t at_ns) noexcept {
  return wall_us() - (monotonic_ns() - at_ns) / 1000;
}

}  // namespace stereod
