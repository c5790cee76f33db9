// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/client/frame_assembler.h"

#include <algorithm>

#include "daemon/client/message_validation.h"

namespace stereod {
namespace {

// Limits of one numbering. Beyond them a message belongs to another numbering; it does not reveal a loss. At 30 frames a
// second: 3 s without reception, half a second of lateness.
constexpr std::int64_t kMaxForward = 100;
constexpr double kMaxPeriod_us = 60e6;  // from one frame to the next
constexpr std::int64_t kMaxBackward = 16;
constexpr int kMessagesToFollow = 3;

StereoFrame empty_frame(std::int64_t frame, std::int64_t utime, int width, int height) {
  StereoFrame result;
  result.frame = frame;
  result.utime = utime;
  result.disparity = DisparityMap(width, height);
  result.row_present.assign(static_cast<std::size_t>(height), false);
  result.rows_expected = height;
  return result;
}

bool is_same_search(const StereoFrame& frame, const disparity_rows_t& m) {
  return frame.units_per_pixel == units_per_pixel_of(m.scale) && frame.min_disparity == m.min_disparity &&
         frame.disparities == m.disparities && frame.grid == RowBlock(m).grid();
}

/// Copies the filled disparities of a row to `filled`.
void copy_filled_row(const RowBlock& block, int y, StereoFrame& out) {
  if (out.filled.width() == 0) out.filled = DisparityMap(out.disparity.width(), out.disparity.height());
  for (int x = 0; x < out.filled.width(); ++x) {
    if (block.is_filled(x, y)) out.filled.row(y)[x] = block.at(x, y, Pixels::kMeasuredOrFilled);
  }
}

void copy_confidence_row(const RowBlock& block, int y, StereoFrame& out) {
  if (out.confidence.width() == 0) {
    out.confidence = ConfidenceMap(out.disparity.width(), out.disparity.height(), 0);
  }
  std::copy_n(block.confidence_row(y), out.confidence.width(), out.confidence.row(y));
}

/// The summary may announce fewer rows than arrived.
void limit_received(StereoFrame& frame) {
  frame.rows_received = std::min(frame.rows_received, frame.rows_expected);
}

}  // namespace

void FrameAssembler::take(const disparity_rows_t& m) {
  if (!is_valid(m)) return count_ignored();
  Slot* slot = slot_for(m.frame, m.utime, m.width, m.height);
  if (slot == nullptr) return;
  if (slot->state == State::kHandedOver) {
    const auto first = slot->out.row_present.begin() + m.first_row;
    const auto known = std::count(first, first + m.row_count, true);
    counts_.rows_duplicate += known;
    if (known < m.row_count) ++counts_.messages_late;
    return;
  }
  if (!add_rows(*slot, m)) return count_ignored();
  limit_received(slot->out);
  if (slot->out.complete()) complete(*slot);
}

/// Copies the rows into the frame. Returns false if their search differs from that of the frame's earlier rows.
bool FrameAssembler::add_rows(Slot& slot, const disparity_rows_t& m) {
  const RowBlock block(m);
  StereoFrame& out = slot.out;
  if (!std::exchange(slot.has_rows, true)) {
    out.units_per_pixel = block.units_per_pixel();
    out.min_disparity = m.min_disparity;
    out.disparities = m.disparities;
    out.grid = block.grid();
  } else if (!is_same_search(out, m)) {
    return false;
  }
  for (int y = m.first_row; y < m.first_row + m.row_count; ++y) {
    if (out.row_present[static_cast<std::size_t>(y)]) {
      ++counts_.rows_duplicate;
      continue;
    }
    out.row_present[static_cast<std::size_t>(y)] = true;
    ++out.rows_received;
    block.copy_row(y, out.disparity.row(y));
    if (block.has_filled()) copy_filled_row(block, y, out);
    if (block.has_confidence()) copy_confidence_row(block, y, out);
  }
  return true;
}

void FrameAssembler::take(const frame_t& m) {
  if (!is_valid(m)) return count_ignored();
  Slot* slot = slot_for(m.frame, m.utime, m.width, m.height);
  if (slot == nullptr) return;
  if (slot->state == State::kHandedOver || slot->out.summary) return;
  slot->out.summary = m;
  slot->out.rows_expected = m.rows;
  limit_received(slot->out);
  if (slot->out.complete()) complete(*slot);
}

void FrameAssembler::finish() {
  if (!started_) return;
  for (std::int64_t frame = oldest_open_; frame < newest_; ++frame) settle(frame, false);
  settle(newest_, true);
  started_ = false;
  jump_messages_ = 0;
}

/// Returns the slot of a frame that is open or was just handed over. Otherwise counts the message and returns nullptr.
FrameAssembler::Slot* FrameAssembler::slot_for(std::int64_t frame, std::int64_t utime, int width,
                                               int height) {
  if (!started_) {
    begin_numbering(frame);
  } else if (!belongs_to_numbering(frame, utime)) {
    if (!follow_jump(frame)) {
      count_ignored();
      return nullptr;
    }
  } else {
    jump_messages_ = 0;
  }
  if (frame > newest_) advance_to(frame);
  // The first frame may arrive after its successor.
  if (frame == newest_ - 1 && oldest_open_ == joined_ && joined_ == newest_) oldest_open_ = joined_ = frame;
  if (frame < oldest_open_) {
    ++counts_.messages_late;
    return nullptr;
  }
  Slot& slot = this->slot(frame);
  if (slot.state == State::kAbsent) {
    slot.out = empty_frame(frame, utime, width, height);
    slot.has_rows = false;
    slot.state = State::kOpen;
    height_ = height;
    if (frame == newest_) newest_utime_ = utime;
  } else if (slot.out.utime != utime || slot.out.row_present.size() != static_cast<std::size_t>(height) ||
             (slot.state == State::kOpen && slot.out.disparity.width() != width)) {
    count_ignored();
    ++counts_.messages_of_another;
    return nullptr;
  }
  return &slot;
}

/// Returns whether a message continues the numbering. A lower number with a later exposure is a restarted daemon.
bool FrameAssembler::belongs_to_numbering(std::int64_t frame, std::int64_t utime) const {
  if (frame == newest_) return true;
  if (frame > newest_) {
    const double step = static_cast<double>(frame - newest_);
    const double time_us = static_cast<double>(utime) - static_cast<double>(newest_utime_);
    return step <= kMaxForward && (newest_utime_ == 0 || (time_us >= 0 && time_us <= step * kMaxPeriod_us));
  }
  return newest_ - frame <= kMaxBackward && utime <= newest_utime_;
}

/// Counts messages that agree on another numbering. Returns true once there are enough of them, and follows them.
bool FrameAssembler::follow_jump(std::int64_t frame) {
  const std::int64_t step = frame - jump_frame_;  // neither is negative
  const bool agrees = jump_messages_ > 0 && step >= -1 && step <= kMaxBackward;
  jump_messages_ = agrees ? jump_messages_ + 1 : 1;
  jump_frame_ = frame;
  if (jump_messages_ < kMessagesToFollow) return false;
  finish();
  ++counts_.restarts;
  begin_numbering(frame);
  return true;
}

void FrameAssembler::begin_numbering(std::int64_t frame) {
  started_ = true;
  joined_ = oldest_open_ = newest_ = frame;
  newest_utime_ = 0;
  jump_messages_ = 0;
}

void FrameAssembler::advance_to(std::int64_t frame) {
  while (oldest_open_ < frame - 1) settle(oldest_open_++, false);
  newest_ = frame;
}

/// Counts a frame, hands it over if it is open, and frees its slot. @p last: it is the last frame of the reception.
void FrameAssembler::settle(std::int64_t frame, bool last) {
  Slot& slot = this->slot(frame);
  const bool here = slot.state != State::kAbsent && slot.out.frame == frame;
  if (!here) {
    ++counts_.frames_expected;
    ++counts_.frames_missing;
    counts_.rows_expected += height_;
    counts_.rows_lost += height_;
    return;
  }
  if (slot.out.complete() || !(last || frame == joined_)) count_settled(slot);
  if (slot.state == State::kOpen) hand_over(slot);
  slot.state = State::kAbsent;
}

void FrameAssembler::count_settled(const Slot& slot) {
  ++counts_.frames_expected;
  ++(slot.out.complete() ? counts_.frames_complete : counts_.frames_incomplete);
  counts_.rows_expected += slot.out.rows_expected;
  counts_.rows_received += slot.out.rows_received;
  counts_.rows_lost += slot.out.rows_expected - slot.out.rows_received;
}

/// Hands over a complete frame, and first its predecessor.
void FrameAssembler::complete(Slot& slot) {
  const std::int64_t before = slot.out.frame - 1;
  Slot& other = this->slot(before);
  if (other.state == State::kOpen && other.out.frame == before) hand_over(other);
  hand_over(slot);
}

/// Hands the frame over. Keeps what is needed to recognize duplicates and to count the frame.
void FrameAssembler::hand_over(Slot& slot) {
  StereoFrame kept;
  kept.frame = slot.out.frame;
  kept.utime = slot.out.utime;
  kept.row_present = slot.out.row_present;
  kept.rows_expected = slot.out.rows_expected;
  kept.rows_received = slot.out.rows_received;
  kept.summary = slot.out.summary;
  slot.state = State::kHandedOver;
  StereoFrame handed = std::exchange(slot.out, std::move(kept));
  handler_(std::move(handed));
}

}  // namespace stereod
