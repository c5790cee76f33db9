// The seam inside the block matcher: how the best disparity of each pixel of a row is found.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "core/base/aligned_buffer.h"
#include "core/base/image.h"
#include "core/match/block/prefilter.h"
#include "core/match/options.h"

namespace stereod {

/// What the search of one row found: an entry for each column in [first, end), none elsewhere. k is
/// disparity − min_disparity; n = min(disparities, x − first + 1) of them were searched in column x.
struct RowWinners {
  /// So many elements from `end` on a search may write over.
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
  AlignedBuffer<std::uint32_t> before;  ///< C(k−1); meaningless where k is the first or last searched
  AlignedBuffer<std::uint32_t> after;   ///< C(k+1); likewise
  AlignedBuffer<std::uint8_t>
      ambiguous;  ///< 1 if some k', |k' − k| > 1, has C(k') ≤ uniqueness_limit(), else 0
};

/// A prefiltered row of both images for a search. The memory stays as it is until `window` more rows were
/// added.
struct SearchRow {
  const std::uint8_t* left;
  const std::uint8_t* right;
  /// Gets the winners of the row in the middle of the last `window` rows; null for the first window − 1 rows.
  RowWinners* winners;
};

/// Takes prefiltered rows one after the other and finds winners for the row in the middle of the last
/// `window` of them. Allocates only in the constructor.
class RowSearch {
 public:
  virtual ~RowSearch() = default;

  /// Forgets all rows.
  virtual void reset() noexcept = 0;

  /// How many rows add_rows() is best given at once.
  virtual int batch() const noexcept { return 1; }

  /// Adds the next rows of both images, at most batch(). Of the winners, `before` and `after` are filled
  /// only with subpixel, `ambiguous` only with uniqueness_ratio.
  virtual void add_rows(std::span<const SearchRow> rows) noexcept = 0;

  /// Writes the disparities of what add_rows() found, from winners.first on: write_disparities() of
  /// row_filters.h, unless the search has a faster way to the same result.
  virtual void write(const RowWinners& winners, std::int16_t* out) const noexcept = 0;

  /// xsobel_row() of prefilter.h, or a faster way to the same result.
  virtual void prefilter_row(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below,
                             int width, int cap, std::uint8_t* out) const noexcept {
    xsobel_row(above, row, below, width, cap, out);
  }

  virtual std::size_t scratch_bytes() const noexcept = 0;
};

/// The columns that have an answer: [min_disparity + r, width − r); empty where first ≥ end.
inline int first_answered_column(const MatcherOptions& options) {
  return options.min_disparity + options.window / 2;
}
inline int end_answered_column(const MatcherOptions& options, int width) {
  return width - options.window / 2;
}

/// The searches of the three implementations, for rows of `width` pixels wide enough to have an answer.
std::unique_ptr<RowSearch> make_naive_search(const MatcherOptions& options, int width);
std::unique_ptr<RowSearch> make_sliding_search(const MatcherOptions& options, int width);
std::unique_ptr<RowSearch> make_simd_search(const MatcherOptions& options, int width);

/// Up to which cost another disparity makes a winner of this cost ambiguous.
inline std::uint64_t uniqueness_limit(std::uint64_t cost, int uniqueness_ratio) {
  return cost + cost * static_cast<std::uint64_t>(uniqueness_ratio) / 100;
}

/// Writes what RowWinners holds for column x, from the costs of the n disparities searched there. Cost(k)
/// returns C(k). The definition of the winner, its neighbors and its rivals (docs/matcher.md, sections 2 to
/// 4).
template <typename CostOf>
void pick_winner(int x, int n, CostOf cost, int uniqueness_ratio, RowWinners& winners) {
  int best = 0;
  for (int k = 1; k < n; ++k) {
    if (cost(k) < cost(best)) best = k;
  }
  const auto at = static_cast<std::size_t>(x);
  winners.index[at] = static_cast<std::uint16_t>(best);
  winners.cost[at] = cost(best);
  winners.before[at] = best > 0 ? cost(best - 1) : 0;
  winners.after[at] = best < n - 1 ? cost(best + 1) : 0;
  if (uniqueness_ratio == 0) return;
  const std::uint64_t limit = uniqueness_limit(cost(best), uniqueness_ratio);
  winners.ambiguous[at] = 0;
  for (int k = 0; k < n; ++k) {
    if ((k < best - 1 || k > best + 1) && cost(k) <= limit) winners.ambiguous[at] = 1;
  }
}

}  // namespace stereod
