// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/semiglobal/reference.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <vector>

#include "core/match/semiglobal/reference_costs.h"

namespace stereod {
namespace {

using semiglobal::as_index;
using semiglobal::Costs;
using semiglobal::CostsOfRow;
using semiglobal::SampledPair;
using semiglobal::size_of;

/// Disparities that differ by less belong to one surface: 1.5 px, in 1/16 px.
constexpr int kNear = 24;

/// The disparity of a sample or a pixel [1/16 px above min_disparity].
struct Value {
  int units;
  bool filled;
};
using ValueRow = std::vector<std::optional<Value>>;

class Reference {
 public:
  Reference(const SampledPair& pair, const ValidityMask* left_mask, const ValidityMask* right_mask)
      : pair_(pair), options_(pair.options), left_mask_(left_mask), right_mask_(right_mask) {}

  DisparityImage match() const {
    const std::vector<CostsOfRow> costs = smoothed_costs(pair_);
    std::vector<ValueRow> grid;
    grid.reserve(costs.size());
    for (int row = 0; row < pair_.grid_height; ++row) {
      grid.push_back(valid_winners(row, path_sums(pair_, costs[as_index(row)], row)));
    }
    if (options_.median > 0) grid = medians(grid);
    if (options_.hole_filling) {
      for (ValueRow& row : grid) fill(row);
    }
    DisparityImage result(pair_.left.size());
    for (int y = 0; y < result.height(); ++y) {
      for (int x = 0; x < result.width(); ++x) result.at(x, y) = output(value_at(grid, x, y), x, y);
    }
    return result;
  }

 private:
  // --- Sections 2.3 and 2.4: winners, interpolation, checks

  ValueRow valid_winners(int grid_y, const CostsOfRow& sums) const {
    std::vector<int> winners;
    for (const Costs& sum : sums) {
      winners.push_back(static_cast<int>(std::min_element(sum.begin(), sum.end()) - sum.begin()));
    }
    ValueRow row(sums.size());
    for (int x = 0; x < size_of(row); ++x) {
      const int winner = winners[as_index(x)];
      if (pair_.match_of(pair_.column(x), winner) < 0 || is_masked(x, grid_y, winner)) continue;
      if (is_ambiguous(sums[as_index(x)], winner) || is_inconsistent(sums, winners, x)) continue;
      row[as_index(x)] = Value{interpolated(sums[as_index(x)], winner), false};
    }
    return row;
  }

  static int interpolated(const Costs& sums, int k) {
    if (k == 0 || k == size_of(sums) - 1) return 16 * k;
    const int before = sums[as_index(k - 1)];
    const int after = sums[as_index(k + 1)];
    const int curvature = before + after - 2 * sums[as_index(k)];
    if (curvature == 0) return 16 * k;
    return 16 * k + rounded(8 * (before - after), curvature);
  }

  // Returns a / b rounded to the nearest integer, halves up; |a| ≤ 8 · b.
  static int rounded(int a, int b) { return (2 * (a + 8 * b) + b) / (2 * b) - 8; }

  bool is_masked(int grid_x, int grid_y, int k) const {
    const int y = pair_.image_row(grid_y);
    const int x = pair_.column(grid_x);
    return (left_mask_ != nullptr && left_mask_->row(y)[x] == 0) ||
           (right_mask_ != nullptr && right_mask_->row(y)[pair_.match_of(x, k)] == 0);
  }

  bool is_ambiguous(const Costs& sums, int winner) const {
    if (options_.uniqueness_ratio == 0) return false;
    const int minimum = sums[as_index(winner)];
    for (int k = 0; k < size_of(sums); ++k) {
      const bool is_neighbor = std::abs(k - winner) <= 1;
      if (!is_neighbor && sums[as_index(k)] <= minimum + minimum * options_.uniqueness_ratio / 100)
        return true;
    }
    return false;
  }

  // Whether the best match of the right sample (on the coarse grid: two right pixels side by side) that
  // sample x matches has a k too different from that of x.
  bool is_inconsistent(const CostsOfRow& sums, const std::vector<int>& winners, int x) const {
    if (options_.left_right_max_diff < 0) return false;
    const auto right_sample = [&](int sample) {
      const int match = pair_.match_of(pair_.column(sample), winners[as_index(sample)]);
      return match < 0 ? -1 : match / pair_.decimation_x;
    };
    const auto cost = [&](int sample) { return sums[as_index(sample)][as_index(winners[as_index(sample)])]; };
    int best = x;
    for (int other = 0; other < pair_.grid_width; ++other) {
      if (right_sample(other) != right_sample(x)) continue;
      const bool lower_k = winners[as_index(other)] < winners[as_index(best)];
      if (cost(other) < cost(best) || (cost(other) == cost(best) && lower_k)) best = other;
    }
    return std::abs(winners[as_index(best)] - winners[as_index(x)]) > options_.left_right_max_diff;
  }

  // --- Section 2.5: median, filling, upsampling

  std::vector<ValueRow> medians(const std::vector<ValueRow>& grid) const {
    std::vector<ValueRow> result = grid;
    for (int y = 1; y < pair_.grid_height - 1; ++y) {
      for (int x = 1; x < pair_.grid_width - 1; ++x) {
        std::vector<int> neighbors;
        for (int v = y - 1; v <= y + 1; ++v) {
          for (int u = x - 1; u <= x + 1; ++u) neighbors.push_back(units_or_none(grid, u, v));
        }
        std::sort(neighbors.begin(), neighbors.end());
        const int middle = thin_or(grid, x, y, neighbors[4]);
        const bool measured = grid[as_index(y)][as_index(x)].has_value();
        result[as_index(y)][as_index(x)].reset();
        if (middle >= 0 && (measured || options_.hole_filling)) {
          result[as_index(y)][as_index(x)] = Value{middle, !measured};
        }
      }
    }
    return result;
  }

  static int units_or_none(const std::vector<ValueRow>& grid, int x, int y) {
    const std::optional<Value>& value = grid[as_index(y)][as_index(x)];
    return value ? value->units : -1;
  }

  // Returns the median of a sample and the two above and below it if that is clearly nearer than the median
  // of nine and one of the other two is close to it, so that thin upright things stay; else the median of
  // nine.
  static int thin_or(const std::vector<ValueRow>& grid, int x, int y, int of_nine) {
    constexpr int kClose = 8;
    std::array<int, 3> column{};
    for (int i = 0; i < 3; ++i) column[as_index(i)] = units_or_none(grid, x, y - 1 + i);
    std::sort(column.begin(), column.end());
    const bool has_another = column[1] - column[0] < kClose || column[2] - column[1] < kClose;
    return column[1] > of_nine + kNear && has_another ? column[1] : of_nine;
  }

  static void fill(ValueRow& row) {
    const ValueRow known = row;
    for (int x = 0; x < size_of(row); ++x) {
      if (known[as_index(x)]) continue;
      std::optional<int> lower;
      const auto look = [&](int step) {
        for (int u = x; u >= 0 && u < size_of(row); u += step) {
          if (!known[as_index(u)]) continue;
          lower = lower ? std::min(*lower, known[as_index(u)]->units) : known[as_index(u)]->units;
          return;
        }
      };
      look(-1);
      look(1);
      if (lower) row[as_index(x)] = Value{*lower, true};
    }
  }

  // Returns what a pixel between a and b has; the steps are its gray steps to the two.
  static std::optional<Value> between(std::optional<Value> a, int step_to_a, std::optional<Value> b,
                                      int step_to_b) {
    if (!a || !b) return a ? a : b;
    if (std::abs(a->units - b->units) < kNear)
      return Value{(a->units + b->units) / 2, a->filled || b->filled};
    if (step_to_a != step_to_b) return step_to_a < step_to_b ? a : b;
    return a->units < b->units ? a : b;
  }

  std::optional<Value> value_in_row(const std::vector<ValueRow>& grid, int x, int grid_y) const {
    const ValueRow& row = grid[as_index(grid_y)];
    const int left = x / pair_.decimation_x;
    if (x % pair_.decimation_x == 0) return row[as_index(left)];
    const int y = pair_.image_row(grid_y);
    return between(row[as_index(left)], pair_.gray_step(x, y, x - 1, y),
                   row[as_index(std::min(left + 1, pair_.grid_width - 1))], pair_.gray_step(x, y, x + 1, y));
  }

  std::optional<Value> value_at(const std::vector<ValueRow>& grid, int x, int y) const {
    const std::optional<Value> upper = value_in_row(grid, x, y / 2);
    if (y % 2 == 0) return upper;
    return between(upper, pair_.gray_step(x, y, x, y - 1),
                   value_in_row(grid, x, std::min(y / 2 + 1, pair_.grid_height - 1)),
                   pair_.gray_step(x, y, x, y + 1));
  }

  std::int16_t output(std::optional<Value> value, int x, int y) const {
    if (!value || (left_mask_ != nullptr && left_mask_->row(y)[x] == 0)) return kInvalidDisparity;
    const int whole = (value->units + 8) / 16;
    const int match = pair_.match_of(x, whole);
    const bool has_match = match >= 0 && (right_mask_ == nullptr || right_mask_->row(y)[match] != 0);
    if (!value->filled && !has_match && !options_.hole_filling) return kInvalidDisparity;
    const auto disparity = static_cast<std::int16_t>(
        options_.subpixel ? 16 * options_.min_disparity + value->units : options_.min_disparity + whole);
    return value->filled || !has_match ? as_filled(disparity) : disparity;
  }

  const SampledPair& pair_;
  const MatcherOptions& options_;
  const ValidityMask* left_mask_;
  const ValidityMask* right_mask_;
};

}  // namespace

DisparityImage semiglobal_reference(GrayView left, GrayView right, const MatcherOptions& options,
                                    const ValidityMask* left_mask, const ValidityMask* right_mask) {
  const SampledPair pair(left, right, options);
  return Reference(pair, left_mask, right_mask).match();
}

}  // namespace stereod
