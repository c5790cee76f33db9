// SPDX-License-Identifier: BSD-3-Clause
// From messages in any order to frames in order.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>

#include "reception_counts.h"  // beside this header, in the source tree and where it is installed
#include "row_block.h"
#include "stereo_frame.h"
#include "stereod/disparity_rows_t.hpp"
#include "stereod/frame_t.hpp"

namespace stereod {

/// Assembles the frames of one daemon. Knows nothing of LCM. Not thread-safe.
///
/// Hands each frame over once, in the order of the frame numbers, at the first of these events: the frame is complete, the
/// next frame is complete, two newer frames have begun, finish().
///
/// A message whose number is more than 100 ahead or 16 behind, or whose exposure does not agree with its number, does not
/// belong to the numbering and is ignored. Three such messages in a row that agree with each other start a new numbering:
/// the daemon was restarted.
class FrameAssembler {
 public:
  using Handler = std::function<void(StereoFrame&&)>;

  explicit FrameAssembler(Handler handler) : handler_(std::move(handler)) {}

  /// Takes any message; counts it as ignored unless is_valid().
  void take(const disparity_rows_t& rows);
  void take(const frame_t& summary);

  /// Counts a message that could not be decoded.
  void count_ignored() { ++counts_.messages_ignored; }

  /// Hands over and counts the open frames. The next message starts a new numbering.
  void finish();

  const ReceptionCounts& counts() const { return counts_; }

 private:
  enum class State { kAbsent, kOpen, kHandedOver };
  struct Slot {
    State state = State::kAbsent;
    bool has_rows = false;
    StereoFrame out;
  };

  Slot* slot_for(std::int64_t frame, std::int64_t utime, int width, int height);
  bool belongs_to_numbering(std::int64_t frame, std::int64_t utime) const;
  bool follow_jump(std::int64_t frame);
  void begin_numbering(std::int64_t frame);
  void advance_to(std::int64_t frame);
  bool add_rows(Slot& slot, const disparity_rows_t& rows);
  void settle(std::int64_t frame, bool last);
  void count_settled(const Slot& slot);
  void complete(Slot& slot);
  void hand_over(Slot& slot);
  Slot& slot(std::int64_t frame) { return slots_[static_cast<std::size_t>(frame & 1)]; }

  Handler handler_;
  ReceptionCounts counts_;
  std::array<Slot, 2> slots_;  // the newest frame and its predecessor
  bool started_ = false;
  std::int64_t joined_ = 0;       // first frame received of this numbering
  std::int64_t oldest_open_ = 0;  // oldest frame that is not settled
  std::int64_t newest_ = 0;
  std::int64_t newest_utime_ = 0;
  std::int64_t jump_frame_ = 0;  // latest frame of a possible new numbering
  int jump_messages_ = 0;        // messages in a row that agree on the new numbering
  int height_ = 0;               // of the latest frame; a missing frame counts as many rows
};

}  // namespace stereod
