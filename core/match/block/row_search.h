// SPDX-License-Identifier: BSD-3-Clause
// The interface inside the block matcher: how the best disparity of each pixel of a row is found.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "core/base/aligned_buffer.h"
#include "core/base/interval.h"
#include "core/match/block/prefilter.h"
#include "core/match/options.h"

namespace stereod {

/// Holds the result of the search for one row: one entry for each column in [first, end). k is
/// disparity − min_disparity; n = min(disparities, x − first + 1) values of k are searched in column x.
struct RowWinners {
  /// A search may overwrite up to kMargin elements past `end`.
  static constexpr int kMargin = 64;

  explicit RowWinners(int width)
      : index(static_cast<std::size_t>(width + kMargin)),
        cost(index.size()),
        before(index.size()),
        after(index.size()),
        ambiguous(index.size()) {}

  std::size_t bytes() const {
    return index.size() * (sizeof(index[0]) + 3 * sizeof(cost[0]) + sizeof(ambiguous[0]));
  }

  int first = 0;
  int end = 0;
  AlignedBuffer<std::uint16_t> index;   ///< k of the winner
  AlignedBuffer<std::uint32_t> cost;    ///< C(k)
  AlignedBuffer<std::uint32_t> before;  ///< C(k−1); undefined where k is the first or last one searched
  AlignedBuffer<std::uint32_t> after;   ///< C(k+1); undefined where k is the first or last one searched
  /// 1 if some k' with |k' − k| > 1 has C(k') ≤ uniqueness_limit(), else 0.
  AlignedBuffer<std::uint8_t> ambiguous;
};

/// A prefiltered row of both images. The memory must stay unchanged until `window` further rows were added.
struct SearchRow {
  const std::uint8_t* left;
  const std::uint8_t* right;
  /// Receives the winners of the row in the middle of the last `window` rows; null for the first window − 1
  /// rows of a band.
  RowWinners* winners;
};

/// Slides the window down the image: takes prefiltered rows in order and finds the winners of the row in the
/// middle of the last `window` of them. Allocates only in the constructor.
class RowSearch {
 public:
  virtual ~RowSearch() = default;

  /// Forgets all rows.
  virtual void reset() noexcept = 0;

  /// Returns how many rows add_rows() takes at most, which is also the fastest number [≥ 1].
  virtual int batch_size() const noexcept { return 1; }

  /// Adds the next rows of both images, 1…batch_size(). Fills `before` and `after` of the winners only with
  /// `subpixel`, and `ambiguous` only with `uniqueness_ratio` > 0.
  virtual void add_rows(std::span<const SearchRow> rows) noexcept = 0;

  /// Writes the disparities of @p winners to @p out[winners.first…winners.end). Same result as
  /// write_disparities() of disparity_checks.h; a search may have a faster way.
  virtual void write(const RowWinners& winners, std::int16_t* out) const noexcept = 0;

  /// Same as xsobel_row() of prefilter.h; a search may have a faster way.
  virtual void prefilter_row(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below,
                             int width, int cap, std::uint8_t* out) const noexcept {
    xsobel_row(above, row, below, width, cap, out);
  }

  virtual std::size_t scratch_bytes() const noexcept = 0;
};

/// Returns the columns that can have a disparity: [min_disparity + r, width − r), r = window / 2. May be
/// empty.
inline ColumnRange valid_columns(const MatcherOptions& options, int width) {
  return {options.min_disparity + options.window / 2, width - options.window / 2};
}

/// Return the search of one implementation, for rows of @p width pixels whose valid_columns() are not empty.
/// make_simd_search() throws std::invalid_argument if the CPU lacks `options.isa`.
std::unique_ptr<RowSearch> make_naive_search(const MatcherOptions& options, int width);
std::unique_ptr<RowSearch> make_sliding_search(const MatcherOptions& options, int width);
std::unique_ptr<RowSearch> make_simd_search(const MatcherOptions& options, int width);

/// Returns the highest cost at which another disparity makes a winner of cost @p cost ambiguous.
/// @p uniqueness_ratio in percent.
inline std::uint64_t uniqueness_limit(std::uint64_t cost, int uniqueness_ratio) {
  return cost + cost * static_cast<std::uint64_t>(uniqueness_ratio) / 100;
}

/// Writes the entry of column @p x to @p winners, from the costs @p cost(k) of the @p n disparities searched
/// there. Reference for the winner, its neighbors and its rivals (docs/matcher.md, sections 2 to 4).
template <typename CostOf>
void pick_winner(int x, int n, CostOf cost, int uniqueness_ratio, RowWinners& winners) {
  int best = 0;
  for (int k = 1; k < n; ++k) {
    if (cost(k) < cost(best)) best = k;
  }
  const auto column = static_cast<std::size_t>(x);
  winners.index[column] = static_cast<std::uint16_t>(best);
  winners.cost[column] = cost(best);
  winners.before[column] = best > 0 ? cost(best - 1) : 0;
  winners.after[column] = best < n - 1 ? cost(best + 1) : 0;
  if (uniqueness_ratio == 0) return;
  const std::uint64_t limit = uniqueness_limit(cost(best), uniqueness_ratio);
  winners.ambiguous[column] = 0;
  for (int k = 0; k < n; ++k) {
    if ((k < best - 1 || k > best + 1) && cost(k) <= limit) winners.ambiguous[column] = 1;
  }
}

}  // namespace stereod
