#include "daemon/tools/tap/frame_assembler.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "daemon/publish/wire_limits.h"

namespace stereod {
namespace {

// Numbers further away than these are another numbering, not a loss. At 30 frames a second: 33 s without
// reception, half a second of lateness.
constexpr std::int64_t kMaxForward = 1000;
constexpr std::int64_t kMaxBackward = 16;
constexpr int kMessagesToFollow = 3;

bool is_image_size(int width, int height) {
  return width >= 1 && width <= kLargestImageSide && height >= 1 && height <= kLargestImageSide;
}

/// Fixed-point units in a pixel for a scale in pixels per unit; 0 if the wire format does not have it.
int units_of(float scale) {
  if (scale == 1.0F) return 1;
  return scale == 1.0F / kSubpixelUnits ? kSubpixelUnits : 0;
}

bool is_sane(const disparity_rows_t& m) {
  constexpr int kMaxDisparity = 4096;
  if (m.frame < 0 || m.utime < 0 || !is_image_size(m.width, m.height)) return false;
  if (m.first_row < 0 || m.row_count < 1 || m.row_count > m.height || m.first_row > m.height - m.row_count) {
    return false;
  }
  if (m.min_disparity < 0 || m.min_disparity > kMaxDisparity) return false;
  if (m.disparities < 1 || m.disparities > kMaxDisparity || units_of(m.scale) == 0) return false;
  if (m.bytes_per_value != 1 && m.bytes_per_value != 2) return false;
  if (m.invalid < 0 || m.invalid > (m.bytes_per_value == 1 ? 0xFF : 0xFFFF)) return false;
  const int expected_size = m.width * m.row_count * m.bytes_per_value;  // at most 2^25
  return m.size == expected_size && m.data.size() == static_cast<std::size_t>(m.size);
}

bool is_sane(const frame_t& m) {
  return m.frame >= 0 && m.utime >= 0 && is_image_size(m.width, m.height) && m.rows >= 0 &&
         m.rows <= m.height && m.messages >= 0 && m.valid_fraction >= 0.0F && m.valid_fraction <= 1.0F;
}

/// One row from wire values; what int16 cannot hold is no disparity either.
void decode_row(const disparity_rows_t& m, int row, std::int16_t* out) {
  const std::uint8_t* in =
      m.data.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(m.width * m.bytes_per_value);
  for (int x = 0; x < m.width; ++x, in += m.bytes_per_value) {
    const int value = m.bytes_per_value == 1 ? in[0] : in[0] | in[1] << 8;
    const bool valid = value != m.invalid && value <= std::numeric_limits<std::int16_t>::max();
    out[x] = valid ? static_cast<std::int16_t>(value) : kInvalidDisparity;
  }
}

AssembledFrame empty_frame(std::int64_t frame, std::int64_t utime, Size size) {
  AssembledFrame result;
  result.frame = frame;
  result.utime = utime;
  result.disparity = DisparityImage(size);
  for (int y = 0; y < size.height; ++y) std::fill_n(result.disparity.row(y), size.width, kInvalidDisparity);
  result.row_present.assign(static_cast<std::size_t>(size.height), false);
  result.rows_expected = size.height;
  return result;
}

bool same_search(const AssembledFrame& frame, const disparity_rows_t& m) {
  return frame.units_per_pixel == units_of(m.scale) && frame.min_disparity == m.min_disparity &&
         frame.disparities == m.disparities;
}

/// Rows received, of those that were published.
void limit_received(AssembledFrame& frame) {
  frame.rows_received = std::min(frame.rows_received, frame.rows_expected);
}

}  // namespace

void FrameAssembler::take(const disparity_rows_t& m) {
  if (!is_sane(m)) return count_ignored();
  Slot* slot = slot_for(m.frame, m.utime, {m.width, m.height});
  if (slot == nullptr) return;
  if (slot->state == State::kHandedOver) {
    counts_.rows_duplicate += m.row_count;
    return;
  }
  AssembledFrame& out = slot->out;
  if (!std::exchange(slot->has_rows, true)) {
    out.units_per_pixel = units_of(m.scale);
    out.min_disparity = m.min_disparity;
    out.disparities = m.disparities;
  } else if (!same_search(out, m)) {
    return count_ignored();
  }
  for (int row = 0; row < m.row_count; ++row) {
    const int y = m.first_row + row;
    if (out.row_present[static_cast<std::size_t>(y)]) {
      ++counts_.rows_duplicate;
      continue;
    }
    out.row_present[static_cast<std::size_t>(y)] = true;
    ++out.rows_received;
    decode_row(m, row, out.disparity.row(y));
  }
  limit_received(out);
  if (out.complete()) hand_over(*slot);
}

void FrameAssembler::take(const frame_t& m) {
  if (!is_sane(m)) return count_ignored();
  Slot* slot = slot_for(m.frame, m.utime, {m.width, m.height});
  if (slot == nullptr) return;
  if (slot->state == State::kHandedOver || slot->out.summary) return;
  slot->out.summary = m;
  slot->out.rows_expected = m.rows;
  limit_received(slot->out);
  if (slot->out.complete()) hand_over(*slot);
}

void FrameAssembler::finish() {
  if (!started_) return;
  for (std::int64_t frame = oldest_open_; frame < newest_; ++frame) settle(frame, false);
  settle(newest_, true);
  started_ = false;
  jump_messages_ = 0;
}

/// The slot of a frame that is still open or was just handed over; nullptr (and a count) if the message is to
/// be passed over.
FrameAssembler::Slot* FrameAssembler::slot_for(std::int64_t frame, std::int64_t utime, Size size) {
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
  // The first frame heard may have been overtaken by the one after it.
  if (frame == newest_ - 1 && oldest_open_ == joined_ && joined_ == newest_) oldest_open_ = joined_ = frame;
  if (frame < oldest_open_) {
    ++counts_.messages_late;
    return nullptr;
  }
  Slot& slot = this->slot(frame);
  if (slot.state == State::kAbsent) {
    slot.out = empty_frame(frame, utime, size);
    slot.has_rows = false;
    slot.state = State::kOpen;
    height_ = size.height;
    if (frame == newest_) newest_utime_ = utime;
  } else if (slot.out.utime != utime ||
             slot.out.row_present.size() != static_cast<std::size_t>(size.height) ||
             (slot.state == State::kOpen && slot.out.disparity.size() != size)) {
    count_ignored();
    return nullptr;
  }
  return &slot;
}

/// Whether a message continues the numbering. A lower number with a later exposure is a daemon that began
/// anew.
bool FrameAssembler::belongs_to_numbering(std::int64_t frame, std::int64_t utime) const {
  if (frame >= newest_) return frame - newest_ <= kMaxForward;
  return newest_ - frame <= kMaxBackward && utime <= newest_utime_;
}

/// Counts messages that agree on another numbering; true when there are enough of them to go over to it.
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

/// Closes a frame's books and frees its slot. `last`: the listening ends with it.
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

/// Gives the frame away, but keeps what is needed to know its duplicates and to count it.
void FrameAssembler::hand_over(Slot& slot) {
  AssembledFrame kept;
  kept.frame = slot.out.frame;
  kept.utime = slot.out.utime;
  kept.row_present = slot.out.row_present;
  kept.rows_expected = slot.out.rows_expected;
  kept.rows_received = slot.out.rows_received;
  kept.summary = slot.out.summary;
  slot.state = State::kHandedOver;
  AssembledFrame handed = std::exchange(slot.out, std::move(kept));
  handler_(std::move(handed));
}

}  // namespace stereod
