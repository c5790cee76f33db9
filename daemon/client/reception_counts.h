// SPDX-License-Identifier: BSD-3-Clause
// What arrived and what did not.
#pragma once

#include <cstdint>
#include <string>

namespace stereod {

/// Counts of a FrameAssembler. A frame is counted once it is settled: when two newer frames have begun, or at finish().
/// The first and the last frame of a reception count only if complete.
struct ReceptionCounts {
  std::int64_t frames_expected = 0;  ///< by their numbers; the sum of the next three
  std::int64_t frames_complete = 0;
  std::int64_t frames_incomplete = 0;  ///< rows or the frame summary are missing
  std::int64_t frames_missing = 0;     ///< no message of the frame arrived
  std::int64_t rows_expected = 0;      ///< the sum of the next two
  std::int64_t rows_received = 0;
  std::int64_t rows_lost = 0;
  std::int64_t rows_duplicate = 0;
  std::int64_t messages_late = 0;     ///< about frames that were handed over already
  std::int64_t messages_ignored = 0;  ///< invalid, contradictory, or far from the current frame number
  /// Valid messages about a frame of the same number with another exposure or size, as a second stereod on the same
  /// channels sends them. Part of messages_ignored.
  std::int64_t messages_of_another = 0;
  std::int64_t restarts = 0;  ///< times the frame numbers started again, with the daemon
};

/// Returns what these counts show to be wrong, and what to do, in sentences; empty if nothing is wrong.
std::string describe_problems(const ReceptionCounts& counts);

}  // namespace stereod
