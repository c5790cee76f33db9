// SPDX-License-Identifier: BSD-3-Clause
// From the winners of a row to its disparities: interpolation, and the checks that make a pixel invalid.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/aligned_buffer.h"
#include "core/match/block/row_search.h"
#include "core/match/options.h"

namespace stereod {

/// Writes the disparity of each column in [winners.first, winners.end): in whole pixels or, with `subpixel`,
/// in 1/16 px (docs/matcher.md, section 3).
void write_disparities(const RowWinners& winners, const MatcherOptions& options, std::int16_t* out) noexcept;

/// Sets pixels with a rival (RowWinners::ambiguous) to kInvalidDisparity.
void reject_ambiguous(const RowWinners& winners, std::int16_t* out) noexcept;

/// Set pixels without a source to kInvalidDisparity: reject_left() at their own column of the left image,
/// reject_right() at the column of their match in the right one. @p valid is a row of a ValidityMask.
void reject_left(const RowWinners& winners, const std::uint8_t* valid, std::int16_t* out) noexcept;
void reject_right(const RowWinners& winners, int min_disparity, const std::uint8_t* valid,
                  std::int16_t* out) noexcept;

/// Sets pixels to kInvalidDisparity that disagree with the best match of their right pixel (docs/matcher.md,
/// section 4, left_right_max_diff).
class LeftRightCheck {
 public:
  /// Allocates memory for rows of @p width pixels.
  explicit LeftRightCheck(int width);
  /// Checks one row. @p options.left_right_max_diff must be ≥ 0.
  void reject(const RowWinners& winners, const MatcherOptions& options, std::int16_t* out) noexcept;
  std::size_t scratch_bytes() const noexcept;

 private:
  static constexpr int kMaxIndices = 256;  // k fits in 8 bits
  static constexpr int kUnroll = 8;

  template <typename Score>
  void reject_inconsistent(Score* matches, Score* best, const RowWinners& winners,
                           const MatcherOptions& options, std::int16_t* out);

  AlignedBuffer<std::uint64_t> matches_;  // by left column: cost and k of its winner
  AlignedBuffer<std::uint64_t> best_;     // by right column, from right to left: the best of its matches
  AlignedBuffer<std::uint16_t> best_k_;   // by left column: k of the best match of its right column
};

/// Sets pixels to kInvalidDisparity whose window has too little horizontal gradient (docs/matcher.md, section
/// 4, texture_threshold). Works on rows of xsobel_row().
class TextureCheck {
 public:
  /// Allocates memory for rows of @p width pixels.
  explicit TextureCheck(int width);
  /// Forgets all rows.
  void reset() noexcept;
  /// Slides the window down by one row: adds row @p added and subtracts row @p removed, which is `window`
  /// rows older, or null while the window fills. @p cap is that of xsobel_row().
  void add_row(const std::uint8_t* added, const std::uint8_t* removed, int cap) noexcept;
  /// Checks the row in the middle of the window. @p options.texture_threshold must be > 0.
  void reject(const RowWinners& winners, const MatcherOptions& options, std::int16_t* out) noexcept;
  std::size_t scratch_bytes() const noexcept;

 private:
  static constexpr int kBlock = 64;  // windows checked together

  // Checks `count` windows; the first one begins at `columns`.
  static void reject_block(const std::int16_t* columns, int window, int threshold, int count,
                           std::int16_t* out);

  int width_;
  AlignedBuffer<std::int16_t> column_sums_;  // each ≤ 31 · 63; kBlock more than the width
};

}  // namespace stereod
