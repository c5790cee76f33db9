// SPDX-License-Identifier: BSD-3-Clause
// The sliding window of the thesis, section 3.7: a window's sum is that of the window before plus what enters
// minus what leaves, first along the row (D to S1), then down the columns (S1 to S2).
#include <algorithm>
#include <cstdlib>

#include "core/match/block/disparity_checks.h"
#include "core/match/block/row_search.h"

namespace stereod {
namespace {

class SlidingSearch final : public RowSearch {
 public:
  SlidingSearch(const MatcherOptions& options, int width)
      : options_(options),
        columns_(width - options.min_disparity),
        difference_(static_cast<std::size_t>(columns_)),
        row_sums_(matrix_size() * static_cast<std::size_t>(options.window)),
        window_sums_(matrix_size()) {}

  void reset() noexcept override {
    row_sums_.fill_zero();
    window_sums_.fill_zero();
    oldest_ = 0;
  }

  void add_rows(std::span<const SearchRow> rows) noexcept override {
    for (const SearchRow& row : rows) add_row(row.left, row.right, row.winners);
  }

  void write(const RowWinners& winners, std::int16_t* out) const noexcept override {
    write_disparities(winners, options_, out);
  }

  std::size_t scratch_bytes() const noexcept override {
    return difference_.size() + row_sums_.size() * sizeof(row_sums_[0]) +
           window_sums_.size() * sizeof(window_sums_[0]);
  }

 private:
  void add_row(const std::uint8_t* left, const std::uint8_t* right, RowWinners* winners) {
    std::uint16_t* s1 = row_sums_.data() + matrix_size() * static_cast<std::size_t>(oldest_);
    for (int k = 0; k < options_.disparities; ++k) {
      const auto offset = static_cast<std::size_t>(k) * static_cast<std::size_t>(columns_);
      difference_row(left, right, k);
      sum_row(k, s1 + offset, window_sums_.data() + offset);
    }
    oldest_ = (oldest_ + 1) % options_.window;
    if (winners != nullptr) search(*winners);
  }

  // Column c of the matrices is image column min_disparity + c.
  std::size_t matrix_size() const {
    return static_cast<std::size_t>(options_.disparities) * static_cast<std::size_t>(columns_);
  }

  // Writes one row of D. Only columns c ≥ k have a pixel at disparity k in the right image.
  void difference_row(const std::uint8_t* left, const std::uint8_t* right, int k) {
    for (int c = k; c < columns_; ++c) {
      difference_[static_cast<std::size_t>(c)] =
          static_cast<std::uint8_t>(std::abs(left[options_.min_disparity + c] - right[c - k]));
    }
  }

  // Writes S1, the sums of D over the `window` columns that end in c. Adds the new S1 to S2 and subtracts the
  // oldest.
  void sum_row(int k, std::uint16_t* s1, std::uint32_t* s2) {
    int sum = 0;
    for (int c = k; c < columns_; ++c) {
      sum += difference_[static_cast<std::size_t>(c)];
      if (c - options_.window >= k) sum -= difference_[static_cast<std::size_t>(c - options_.window)];
      if (c - options_.window + 1 < k) continue;
      s2[c] += static_cast<std::uint32_t>(sum) - s1[c];
      s1[c] = static_cast<std::uint16_t>(sum);
    }
  }

  void search(RowWinners& winners) {
    for (int x = winners.first; x < winners.end; ++x) {
      const int n = std::min(options_.disparities, x - winners.first + 1);
      const std::uint32_t* s2 = window_sums_.data() + x + options_.window / 2 - options_.min_disparity;
      pick_winner(
          x, n, [&](int k) { return s2[static_cast<std::ptrdiff_t>(k) * columns_]; },
          options_.uniqueness_ratio, winners);
    }
  }

  MatcherOptions options_;
  int columns_;
  AlignedBuffer<std::uint8_t> difference_;    // D, one disparity at a time
  AlignedBuffer<std::uint16_t> row_sums_;     // S1 of the last `window` rows, [row][k][c]
  AlignedBuffer<std::uint32_t> window_sums_;  // S2, [k][c]
  int oldest_ = 0;                            // the S1 row that the next one replaces
};

}  // namespace

std::unique_ptr<RowSearch> make_sliding_search(const MatcherOptions& options, int width) {
  return std::make_unique<SlidingSearch>(options, width);
}

}  // namespace stereod
