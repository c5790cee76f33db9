// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/client/reception_counts.h"

namespace stereod {

std::string describe_problems(const ReceptionCounts& counts) {
  std::string text;
  const auto add = [&text](const std::string& sentence) { text += (text.empty() ? "" : " ") + sentence; };
  if (counts.restarts >= 3) {
    add("The frame numbers restarted " + std::to_string(counts.restarts) +
        " times: either stereod keeps restarting, or two of them publish on the same channels; give each its "
        "own lcm.prefix.");
  }
  if (counts.messages_of_another > 0) {
    add(std::to_string(counts.messages_of_another) +
        " messages describe other frames with the same numbers: another stereod publishes on the same "
        "channels; give each its own lcm.prefix.");
  }
  if (const auto others = counts.messages_ignored - counts.messages_of_another; others > 0) {
    add(std::to_string(others) +
        " messages are not messages of this stereod: another program, or a stereod of another version, "
        "publishes on its channels.");
  }
  if (counts.rows_lost > 0 || counts.frames_missing > 0) {
    add(std::to_string(counts.rows_lost) + " of " + std::to_string(counts.rows_expected) +
        " rows were lost: the program is slower than the stream, or the kernel's receive buffer is small "
        "(net.core.rmem_max).");
  }
  return text;
}

}  // namespace stereod
