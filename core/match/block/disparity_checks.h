// From a row's winners to its disparities: interpolation and the tests that make a pixel invalid. Each costs
// nothing when it is off.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/aligned_buffer.h"
#include "core/match/block/row_search.h"
#include "core/match/options.h"

namespace stereod {

/// Writes the disparity of each column in [winners.first, winners.end): whole pixels or, with subpixel, 1/16
/// px (docs/matcher.md, section 3).
void write_disparities(const RowWinners& winners, const MatcherOptions& options, std::int16_t* out) noexcept;

/// Invalidates pixels with a rival (RowWinners::ambiguous).
void reject_ambiguous(const RowWinners& winners, std::int16_t* out) noexcept;

/// Invalidates pixels that the mask of their image says show nothing: of the left one at their own column,
/// of the right one at that of their match. `valid` is a row of a ValidityMask.
void reject_left(const RowWinners& winners, const std::uint8_t* valid, std::int16_t* out) noexcept;
void reject_right(const RowWinners& winners, int min_disparity, const std::uint8_t* valid,
                  std::int16_t* out) noexcept;

/// Invalidates pixels whose match in the right image is claimed by a better one of other disparity.
class LeftRightCheck {
 public:
  explicit LeftRightCheck(int width);
  void reject(const RowWinners& winners, const MatcherOptions& options, std::int16_t* out) noexcept;
  std::size_t scratch_bytes() const noexcept;

 private:
  static constexpr int kMaxIndices = 256;  // k fits in 8 bits
  static constexpr int kUnroll = 8;

  template <typename Claim>
  void reject_by(Claim* claims, Claim* standing, const RowWinners& winners, const MatcherOptions& options,
                 std::int16_t* out);

  AlignedBuffer<std::uint64_t> claims_;          // by column of the left image
  AlignedBuffer<std::uint64_t> standing_;        // by column of the right image, from right to left
  AlignedBuffer<std::uint16_t> standing_index_;  // k of the claim that stands where each left column claims
};

/// Invalidates pixels whose window has too little horizontal gradient to be matched. Works on xsobel rows.
class TextureCheck {
 public:
  explicit TextureCheck(int width);
  void reset() noexcept;
  /// `added` comes into the window; `removed`, `window` rows older, leaves it, or is null while it fills.
  void add_row(const std::uint8_t* added, const std::uint8_t* removed, int cap) noexcept;
  void reject(const RowWinners& winners, const MatcherOptions& options, std::int16_t* out) noexcept;
  std::size_t scratch_bytes() const noexcept;

 private:
  static constexpr int kBlock = 64;  // windows looked at together

  // `columns` are those of the first of `count` windows and of all after it.
  static void reject_block(const std::int16_t* columns, int window, int threshold, int count,
                           std::int16_t* out);

  int width_;
  AlignedBuffer<std::int16_t> column_sums_;  // at most 31 rows of 63; a block more than the width
};

}  // namespace stereod
