// SPDX-License-Identifier: BSD-3-Clause
// Spreads the messages of a frame over time, so that they do not overrun the socket buffers of receivers.
#pragma once

#include <cstddef>
#include <cstdint>

namespace stereod {

/// Limits the rate of sent bytes: a burst passes at once, further bytes wait. One thread uses it.
class Pacer {
 public:
  /// Spreads @p bytes_of_frame over @p pacing_s [s]; 0: never waits.
  Pacer(double pacing_s, double bytes_of_frame)
      : ns_per_byte_(pacing_s > 0 ? pacing_s * 1e9 / bytes_of_frame : 0) {}

  /// Waits until @p bytes may be sent.
  void wait_to_send(std::size_t bytes) noexcept;

 private:
  const double ns_per_byte_;
  std::int64_t sent_until_ns_ = 0;  // when everything so far is sent at the paced rate
};

}  // namespace stereod
