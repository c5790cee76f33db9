// Whole disparity images from the rows that arrive.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/disparity.h"
#include "stereod/disparity_rows_t.hpp"
#include "stereod/frame_t.hpp"

namespace stereod {

/// A frame put together again, as far as it arrived.
struct AssembledFrame {
  std::int64_t frame = 0;
  std::int64_t utime = 0;          ///< µs since the Unix epoch, exposure of the left frame
  DisparityImage disparity;        ///< rows that did not arrive are kInvalidDisparity
  int units_per_pixel = 1;         ///< 1 or kSubpixelUnits
  int min_disparity = 0;           ///< px
  int disparities = 0;             ///< px; 0 if not one row arrived
  std::vector<bool> row_present;   ///< one for each row of the image
  int rows_expected = 0;           ///< as many as the daemon says it published, or else the image's height
  int rows_received = 0;           ///< never more than rows_expected
  std::optional<frame_t> summary;  ///< nothing if the daemon's message about this frame did not arrive

  bool complete() const { return summary.has_value() && rows_received >= rows_expected; }
};

/// What arrived and what did not. A frame is counted once it is settled: when two newer ones have begun, or
/// at finish(). The frame in which the listening began, and the one in which it ended, count only if
/// complete.
struct ReceptionCounts {
  std::int64_t frames_expected = 0;  ///< by their numbers; the sum of the next three
  std::int64_t frames_complete = 0;
  std::int64_t frames_incomplete = 0;  ///< rows or the message about the frame missing
  std::int64_t frames_missing = 0;     ///< nothing of them arrived
  std::int64_t rows_expected = 0;      ///< the sum of the next two
  std::int64_t rows_received = 0;
  std::int64_t rows_lost = 0;
  std::int64_t rows_duplicate = 0;
  std::int64_t messages_late = 0;     ///< about frames that were settled already
  std::int64_t messages_ignored = 0;  ///< contradictory, out of range, or numbered like no frame near
  std::int64_t restarts = 0;          ///< times the numbering began anew, with the daemon
};

/// Takes the messages of one daemon in any order and hands each frame over once: as soon as it is complete,
/// else when two newer ones have begun. Numbering that jumps (a daemon that was started again) is followed
/// after three messages in a row that agree, so that a single foreign message does no harm. Knows nothing of
/// LCM; not thread-safe.
class FrameAssembler {
 public:
  using Handler = std::function<void(AssembledFrame&&)>;

  explicit FrameAssembler(Handler handler) : handler_(std::move(handler)) {}

  /// Any message whatever; what is not sane is counted as ignored.
  void take(const disparity_rows_t& rows);
  void take(const frame_t& summary);

  /// A message that could not even be decoded.
  void count_ignored() { ++counts_.messages_ignored; }

  /// Hands over and counts what is still open. The next message begins anew.
  void finish();

  const ReceptionCounts& counts() const { return counts_; }

 private:
  enum class State { kAbsent, kOpen, kHandedOver };
  struct Slot {
    State state = State::kAbsent;
    bool has_rows = false;
    AssembledFrame out;
  };

  Slot* slot_for(std::int64_t frame, std::int64_t utime, Size size);
  bool belongs_to_numbering(std::int64_t frame, std::int64_t utime) const;
  bool follow_jump(std::int64_t frame);
  void begin_numbering(std::int64_t frame);
  void advance_to(std::int64_t frame);
  void settle(std::int64_t frame, bool last);
  void count_settled(const Slot& slot);
  void hand_over(Slot& slot);
  Slot& slot(std::int64_t frame) { return slots_[static_cast<std::size_t>(frame & 1)]; }

  Handler handler_;
  ReceptionCounts counts_;
  std::array<Slot, 2> slots_;  // the newest frame and the one before it
  bool started_ = false;
  std::int64_t joined_ = 0;       // the frame in which this numbering was first heard
  std::int64_t oldest_open_ = 0;  // the oldest one not settled
  std::int64_t newest_ = 0;
  std::int64_t newest_utime_ = 0;
  std::int64_t jump_frame_ = 0;  // where the numbering seems to have jumped to
  int jump_messages_ = 0;        // how many messages in a row say so
  int height_ = 0;               // of the latest frame: what a missing one is taken to have had
};

}  // namespace stereod
