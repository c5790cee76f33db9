// SPDX-License-Identifier: BSD-3-Clause
// Pairs the frames of two free-running cameras.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

namespace stereod {

enum class Side { kLeft, kRight };
constexpr Side opposite(Side side) { return side == Side::kLeft ? Side::kRight : Side::kLeft; }

/// A left and a right frame taken at about the same time.
template <typename Frame>
struct FramePair {
  Frame left, right;
  std::int64_t left_ns = 0, right_ns = 0;  ///< capture times
  std::int64_t skew_ns() const { return right_ns - left_ns; }
};

/// Numbers of pairs and dropped frames.
struct PairingCounts {
  std::int64_t pairs = 0;                    ///< made, taken or not
  std::int64_t pairs_superseded = 0;         ///< replaced by a newer pair before they were taken
  std::int64_t left_without_partner = 0;     ///< left frames without a right frame within the tolerance
  std::int64_t right_without_partner = 0;    ///< right frames without a left frame within the tolerance
  std::int64_t frames_before_time_jump = 0;  ///< dropped because the timestamps of a camera went backwards
};

/// Pairs frames by nearest capture time, newest first. Holds at most one frame of each camera that waits for
/// a partner, and one pair that waits to be taken; drops and counts all others at once, so that nothing
/// queues up. Frame is movable (for example a lease on a buffer); dropping a frame destroys it.
///
/// A frame is paired with the waiting frame of the other camera if they are within the tolerance. Else, if it
/// is nearer to a member of the pair not yet taken than that member's partner is, it replaces the partner.
/// With a tolerance of half a frame period the first rule alone finds the nearest frame.
template <typename Frame>
class Pairing {
 public:
  /// @p tolerance_ns: maximum difference of the capture times of a pair.
  explicit Pairing(std::int64_t tolerance_ns) : tolerance_ns_(tolerance_ns) {}

  /// Adds a frame of one camera, captured at @p time_ns.
  void add(Side side, Frame frame, std::int64_t time_ns) {
    notice_time_jump(side, time_ns);
    Waiting& own = waiting(side);
    Waiting& other = waiting(opposite(side));
    if (other && distance(other->time_ns, time_ns) <= tolerance_ns_) {
      if (own) drop(side);
      make_pair(side, std::move(frame), time_ns);
    } else if (is_nearer_than_partner(side, time_ns)) {
      replace_partner(side, std::move(frame), time_ns);
    } else if (other && other->time_ns > time_ns) {
      count_without_partner(side);  // later frames of the other camera are even later
    } else {
      if (other) drop(opposite(side));  // later frames of this camera are even later
      if (own) drop(side);
      own.emplace(TimedFrame{std::move(frame), time_ns});
    }
  }

  void set_tolerance_ns(std::int64_t tolerance_ns) { tolerance_ns_ = tolerance_ns; }

  /// Drops the frame of one camera that waits for a partner, because that camera has stopped.
  void forget_waiting(Side side) {
    if (waiting(side)) drop(side);
  }

  bool has_pair() const { return ready_.has_value(); }

  /// Returns the newest pair, unless it was taken before.
  std::optional<FramePair<Frame>> take() { return std::exchange(ready_, std::nullopt); }

  /// Drops all frames.
  void clear() {
    left_.reset();
    right_.reset();
    ready_.reset();
  }

  const PairingCounts& counts() const { return counts_; }

 private:
  struct TimedFrame {
    Frame frame;
    std::int64_t time_ns;
  };
  using Waiting = std::optional<TimedFrame>;

  static std::int64_t distance(std::int64_t a, std::int64_t b) { return a > b ? a - b : b - a; }
  Waiting& waiting(Side side) { return side == Side::kLeft ? left_ : right_; }

  void notice_time_jump(Side side, std::int64_t time_ns) {
    std::optional<std::int64_t>& last = side == Side::kLeft ? last_left_ns_ : last_right_ns_;
    if (last && time_ns < *last) {
      counts_.frames_before_time_jump += (left_ ? 1 : 0) + (right_ ? 1 : 0);
      left_.reset();
      right_.reset();
    }
    last = time_ns;
  }

  void make_pair(Side side, Frame frame, std::int64_t time_ns) {
    TimedFrame partner = std::move(*waiting(opposite(side)));
    waiting(opposite(side)).reset();
    if (ready_) ++counts_.pairs_superseded;
    ++counts_.pairs;
    if (side == Side::kLeft) {
      ready_.emplace(FramePair<Frame>{std::move(frame), std::move(partner.frame), time_ns, partner.time_ns});
    } else {
      ready_.emplace(FramePair<Frame>{std::move(partner.frame), std::move(frame), partner.time_ns, time_ns});
    }
  }

  bool is_nearer_than_partner(Side side, std::int64_t time_ns) const {
    if (!ready_) return false;
    const std::int64_t fixed_ns = side == Side::kLeft ? ready_->right_ns : ready_->left_ns;
    return distance(fixed_ns, time_ns) < distance(ready_->left_ns, ready_->right_ns);
  }

  void replace_partner(Side side, Frame frame, std::int64_t time_ns) {
    count_without_partner(side);
    (side == Side::kLeft ? ready_->left : ready_->right) = std::move(frame);
    (side == Side::kLeft ? ready_->left_ns : ready_->right_ns) = time_ns;
  }

  void drop(Side side) {
    waiting(side).reset();
    count_without_partner(side);
  }

  void count_without_partner(Side side) {
    ++(side == Side::kLeft ? counts_.left_without_partner : counts_.right_without_partner);
  }

  std::int64_t tolerance_ns_;
  Waiting left_, right_;
  std::optional<std::int64_t> last_left_ns_, last_right_ns_;
  std::optional<FramePair<Frame>> ready_;
  PairingCounts counts_;
};

}  // namespace stereod
