// SPDX-License-Identifier: BSD-3-Clause
// The reference search: compares the whole window for each pixel and disparity (thesis, listing A.1).
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "core/match/block/disparity_checks.h"
#include "core/match/block/row_search.h"

namespace stereod {
namespace {

class NaiveSearch final : public RowSearch {
 public:
  explicit NaiveSearch(const MatcherOptions& options)
      : options_(options),
        left_(static_cast<std::size_t>(options.window)),
        right_(static_cast<std::size_t>(options.window)),
        costs_(static_cast<std::size_t>(options.disparities)) {}

  void reset() noexcept override {}

  void add_rows(std::span<const SearchRow> rows) noexcept override {
    for (const SearchRow& row : rows) add_row(row.left, row.right, row.winners);
  }

  void write(const RowWinners& winners, std::int16_t* out) const noexcept override {
    write_disparities(winners, options_, out);
  }

  std::size_t scratch_bytes() const noexcept override {
    return (left_.size() + right_.size()) * sizeof(left_[0]) + costs_.size() * sizeof(costs_[0]);
  }

 private:
  void add_row(const std::uint8_t* left, const std::uint8_t* right, RowWinners* winners) {
    std::rotate(left_.begin(), left_.begin() + 1, left_.end());
    std::rotate(right_.begin(), right_.begin() + 1, right_.end());
    left_.back() = left;
    right_.back() = right;
    if (winners != nullptr) search(*winners);
  }

  void search(RowWinners& winners) {
    for (int x = winners.first; x < winners.end; ++x) {
      const int n = std::min(options_.disparities, x - winners.first + 1);
      for (int k = 0; k < n; ++k)
        costs_[static_cast<std::size_t>(k)] = window_cost(x, options_.min_disparity + k);
      pick_winner(
          x, n, [this](int k) { return costs_[static_cast<std::size_t>(k)]; }, options_.uniqueness_ratio,
          winners);
    }
  }

  // Thesis, equations 2.1 (sum of absolute differences), 2.2 (sum of squares) and 2.3 (maximum).
  std::uint32_t window_cost(int x, int disparity) const {
    const int r = options_.window / 2;
    std::uint32_t cost = 0;
    for (std::size_t row = 0; row < left_.size(); ++row) {
      for (int i = -r; i <= r; ++i) {
        const auto difference =
            static_cast<std::uint32_t>(std::abs(left_[row][x + i] - right_[row][x + i - disparity]));
        switch (options_.cost) {
          case Cost::kSad:
            cost += difference;
            break;
          case Cost::kSsd:
            cost += difference * difference;
            break;
          case Cost::kMad:
            cost = std::max(cost, difference);
            break;
        }
      }
    }
    return cost;
  }

  MatcherOptions options_;
  std::vector<const std::uint8_t*> left_;  // the last `window` rows, oldest first
  std::vector<const std::uint8_t*> right_;
  std::vector<std::uint32_t> costs_;
};

}  // namespace

std::unique_ptr<RowSearch> make_naive_search(const MatcherOptions& options, int /*width*/) {
  return std::make_unique<NaiveSearch>(options);
}

}  // namespace stereod
