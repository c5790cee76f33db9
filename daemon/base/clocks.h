// The two clocks of the daemon.
#pragma once

#include <chrono>
#include <cstdint>

namespace stereod {

/// CLOCK_MONOTONIC in ns: what everything inside is measured with.
inline std::int64_t monotonic_ns() noexcept {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// µs since the Unix epoch: what messages carry.
inline std::int64_t wall_us() noexcept {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// The wall-clock time of a moment that the monotonic clock measured.
inline std::int64_t wall_us_of(std::int64_t at_ns) noexcept {
  return wall_us() - (monotonic_ns() - at_ns) / 1000;
}

}  // namespace stereod
