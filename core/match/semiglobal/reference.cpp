#include "core/match/semiglobal/reference.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <optional>
#include <vector>

namespace stereod {
namespace {

/// Costs, or sums of costs along paths, of one pixel: one for each disparity searched, at most kMax.
using Costs = std::vector<int>;
constexpr int kMax = 255;

/// Disparities that differ by less are of one surface: 1.5 px, in 1/16 px.
constexpr int kNear = 24;

/// A row of pixels, or of points of the grid, with their costs.
using CostRow = std::vector<Costs>;

/// What stands at a point of the grid or at a pixel: 1/16 px from min_disparity on, measured or filled in.
struct Value {
  int units;
  bool filled;
};
using ValueRow = std::vector<std::optional<Value>>;

std::size_t at(int i) { return static_cast<std::size_t>(i); }
int size_of(const auto& container) { return static_cast<int>(container.size()); }
int average(int a, int b) { return (a + b + 1) / 2; }

/// The pixel at (x, y), or the nearest one if that lies outside.
int pixel(GrayView picture, int x, int y) {
  return picture.at(std::clamp(x, 0, picture.width() - 1), std::clamp(y, 0, picture.height() - 1));
}

/// Eight pairs of pixels on opposite sides of (x, y): a bit for each, 1 where the first one is the brighter.
int census(GrayView picture, int x, int y) {
  constexpr std::array<std::array<int, 2>, 8> kFirst{
      {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {-2, 0}, {-2, -2}, {0, -2}, {2, -2}}};
  int bits = 0;
  for (const auto& [dx, dy] : kFirst) {
    bits = 2 * bits + (pixel(picture, x + dx, y + dy) > pixel(picture, x - dx, y - dy) ? 1 : 0);
  }
  return bits;
}

int gradient(GrayView picture, int x, int y, int cap) {
  if (x == 0 || x == picture.width() - 1) return 0;
  const auto mirrored = [height = picture.height()](int row) {
    if (height == 1) return 0;
    return row < 0 ? -row : row >= height ? 2 * (height - 1) - row : row;
  };
  const auto step = [&](int row) {
    return picture.at(x + 1, mirrored(row)) - picture.at(x - 1, mirrored(row));
  };
  return std::clamp(step(y - 1) + 2 * step(y) + step(y + 1), -cap, cap);
}

/// Weights 1 2 2 2 1 over five neighbors, by averages of two that round up.
int smoothed(int a, int b, int c, int d, int e) {
  return average(average(average(a, b), average(c, d)), average(average(b, c), average(d, e)));
}

/// smoothed() at element i, for each disparity; elements outside are the nearest ones.
Costs smoothed_at(const std::vector<const Costs*>& elements, int i) {
  const auto element = [&](int j) -> const Costs& {
    return *elements[at(std::clamp(j, 0, size_of(elements) - 1))];
  };
  Costs result(element(i).size());
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] =
        smoothed(element(i - 2)[k], element(i - 1)[k], element(i)[k], element(i + 1)[k], element(i + 2)[k]);
  }
  return result;
}

class Reference {
 public:
  Reference(GrayView left, GrayView right, const MatcherOptions& options, const ValidityMask* left_mask,
            const ValidityMask* right_mask)
      : left_(left),
        right_(right),
        options_(options),
        left_mask_(left_mask),
        right_mask_(right_mask),
        column_step_(options.grid == Grid::kCoarse ? 2 : 1),
        grid_width_((left.width() + column_step_ - 1) / column_step_),
        grid_height_((left.height() + 1) / 2) {}

  DisparityImage match() const {
    std::vector<CostRow> across;
    for (int row = 0; row < grid_height_; ++row) across.push_back(costs_smoothed_across(row));
    std::vector<ValueRow> grid;
    for (int row = 0; row < grid_height_; ++row)
      grid.push_back(values(row, costs_smoothed_down(across, row)));
    if (options_.median > 0) grid = medians(grid);
    if (options_.hole_filling) {
      for (ValueRow& row : grid) fill(row);
    }
    DisparityImage result(left_.size());
    for (int y = 0; y < result.height(); ++y) {
      for (int x = 0; x < result.width(); ++x) result.at(x, y) = output(value_at(grid, x, y), x, y);
    }
    return result;
  }

 private:
  int column(int grid_x) const { return grid_x * column_step_; }
  static int image_row(int grid_y) { return 2 * grid_y; }
  int match_of(int x, int k) const { return x - options_.min_disparity - k; }

  // --- 1: how well pixels look alike

  Costs costs_of_pixel(int x, int y) const {
    Costs costs;
    for (int k = 0; k < options_.disparities; ++k) {
      const int match = match_of(x, k);
      if (match < 0) {
        costs.push_back(options_.gradient_limit);
        continue;
      }
      const auto differing =
          static_cast<unsigned>(census(left_, x, y)) ^ static_cast<unsigned>(census(right_, match, y));
      const int step = std::abs(gradient(left_, x, y, options_.prefilter_cap) -
                                gradient(right_, match, y, options_.prefilter_cap));
      costs.push_back(options_.census_weight * __builtin_popcount(differing) +
                      std::min(step, options_.gradient_limit));
    }
    return costs;
  }

  CostRow costs_smoothed_across(int grid_y) const {
    CostRow pixels;
    for (int x = 0; x < left_.width(); ++x) pixels.push_back(costs_of_pixel(x, image_row(grid_y)));
    std::vector<const Costs*> elements;
    for (const Costs& costs : pixels) elements.push_back(&costs);
    CostRow smooth;
    for (int grid_x = 0; grid_x < grid_width_; ++grid_x)
      smooth.push_back(smoothed_at(elements, column(grid_x)));
    return smooth;
  }

  CostRow costs_smoothed_down(const std::vector<CostRow>& rows, int grid_y) const {
    CostRow smooth;
    for (int grid_x = 0; grid_x < grid_width_; ++grid_x) {
      std::vector<const Costs*> elements;
      for (const CostRow& row : rows) elements.push_back(&row[at(grid_x)]);
      smooth.push_back(smoothed_at(elements, grid_y));
    }
    return smooth;
  }

  // --- 2: paths along the row

  /// What the path pays at a point at least, for each disparity, if it came by the point before.
  Costs arriving(const Costs& before, int most) const {
    const int least = *std::min_element(before.begin(), before.end());
    Costs result(before.size());
    for (int k = 0; k < size_of(before); ++k) {
      int best = std::min(before[at(k)] - least, most);
      if (k > 0) best = std::min(best, before[at(k - 1)] - least + options_.p1);
      if (k + 1 < size_of(before)) best = std::min(best, before[at(k + 1)] - least + options_.p1);
      result[at(k)] = best;
    }
    return result;
  }

  /// Costs along the path that comes to every point from the side of `step` = 1 (left) or -1 (right).
  CostRow path(const CostRow& costs, int grid_y, int step) const {
    CostRow result(costs.size());
    const int first = step > 0 ? 0 : grid_width_ - 1;
    for (int i = 0, x = first; i < grid_width_; ++i, x += step) {
      result[at(x)] = costs[at(x)];
      if (x == first) continue;
      const int gray_step = std::abs(pixel(left_, column(x), image_row(grid_y)) -
                                     pixel(left_, column(x - step), image_row(grid_y)));
      const Costs arrived = arriving(result[at(x - step)], std::max(0, options_.p2 - gray_step));
      for (std::size_t k = 0; k < arrived.size(); ++k) {
        result[at(x)][k] = std::min(kMax, costs[at(x)][k] + arrived[k]);
      }
    }
    return result;
  }

  // --- 3: winners, interpolation, tests

  ValueRow values(int grid_y, const CostRow& costs) const {
    const CostRow from_left = path(costs, grid_y, 1);
    CostRow sums = path(costs, grid_y, -1);
    std::vector<int> winners;
    for (int x = 0; x < grid_width_; ++x) {
      Costs& sum = sums[at(x)];
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] = std::min(kMax, sum[k] + from_left[at(x)][k]);
      winners.push_back(static_cast<int>(std::min_element(sum.begin(), sum.end()) - sum.begin()));
    }
    ValueRow row(at(grid_width_));
    for (int x = 0; x < grid_width_; ++x) {
      if (match_of(column(x), winners[at(x)]) < 0 || is_masked(x, grid_y, winners[at(x)])) continue;
      if (is_ambiguous(sums[at(x)], winners[at(x)]) || is_contested(sums, winners, x)) continue;
      row[at(x)] = Value{interpolated(sums[at(x)], winners[at(x)]), false};
    }
    return row;
  }

  static int interpolated(const Costs& sums, int k) {
    if (k == 0 || k == size_of(sums) - 1) return 16 * k;
    const int before = sums[at(k - 1)];
    const int after = sums[at(k + 1)];
    const int curvature = before + after - 2 * sums[at(k)];
    if (curvature == 0) return 16 * k;
    return 16 * k + rounded(8 * (before - after), curvature);
  }

  // Halves are rounded up; |a| ≤ 8 · b.
  static int rounded(int a, int b) { return (2 * (a + 8 * b) + b) / (2 * b) - 8; }

  bool is_masked(int grid_x, int grid_y, int k) const {
    const int y = image_row(grid_y);
    const int x = column(grid_x);
    return (left_mask_ != nullptr && left_mask_->row(y)[x] == 0) ||
           (right_mask_ != nullptr && right_mask_->row(y)[match_of(x, k)] == 0);
  }

  bool is_ambiguous(const Costs& sums, int winner) const {
    if (options_.uniqueness_ratio == 0) return false;
    const int least = sums[at(winner)];
    for (int k = 0; k < size_of(sums); ++k) {
      const bool beside = std::abs(k - winner) <= 1;
      if (!beside && sums[at(k)] <= least + least * options_.uniqueness_ratio / 100) return true;
    }
    return false;
  }

  /// Does another point, with a disparity too different, have the better claim on the right pixels (on the
  /// coarse grid two of them side by side) where this one finds its match?
  bool is_contested(const CostRow& sums, const std::vector<int>& winners, int x) const {
    if (options_.left_right_max_diff < 0) return false;
    const auto claimed = [&](int point) {
      const int match = match_of(column(point), winners[at(point)]);
      return match < 0 ? -1 : match / column_step_;
    };
    int standing = x;
    for (int other = 0; other < grid_width_; ++other) {
      if (claimed(other) != claimed(x)) continue;
      const int cost = sums[at(other)][at(winners[at(other)])];
      const int standing_cost = sums[at(standing)][at(winners[at(standing)])];
      if (cost < standing_cost || (cost == standing_cost && winners[at(other)] < winners[at(standing)])) {
        standing = other;
      }
    }
    return std::abs(winners[at(standing)] - winners[at(x)]) > options_.left_right_max_diff;
  }

  // --- 4: the grid is smoothed and filled

  std::vector<ValueRow> medians(const std::vector<ValueRow>& grid) const {
    std::vector<ValueRow> result = grid;
    for (int y = 1; y < grid_height_ - 1; ++y) {
      for (int x = 1; x < grid_width_ - 1; ++x) {
        std::vector<int> around;
        for (int v = y - 1; v <= y + 1; ++v) {
          for (int u = x - 1; u <= x + 1; ++u)
            around.push_back(grid[at(v)][at(u)] ? grid[at(v)][at(u)]->units : -1);
        }
        std::sort(around.begin(), around.end());
        const int middle = thin_or(grid, x, y, around[4]);
        const bool measured = grid[at(y)][at(x)].has_value();
        result[at(y)][at(x)].reset();
        if (middle >= 0 && (measured || options_.hole_filling))
          result[at(y)][at(x)] = Value{middle, !measured};
      }
    }
    return result;
  }

  /// The median of a point and the two above and below, if it is clearly nearer than the one of nine and
  /// there is another like it, so that what is thin and upright stays; else the one of nine.
  static int thin_or(const std::vector<ValueRow>& grid, int x, int y, int of_nine) {
    constexpr int kClose = 8;
    std::array<int, 3> column{};
    for (int i = 0; i < 3; ++i) {
      const std::optional<Value>& value = grid[at(y - 1 + i)][at(x)];
      column[at(i)] = value ? value->units : -1;
    }
    std::sort(column.begin(), column.end());
    const bool has_another = column[1] - column[0] < kClose || column[2] - column[1] < kClose;
    return column[1] > of_nine + kNear && has_another ? column[1] : of_nine;
  }

  static void fill(ValueRow& row) {
    const ValueRow known = row;
    for (int x = 0; x < size_of(row); ++x) {
      if (known[at(x)]) continue;
      std::optional<int> least;
      const auto look = [&](int step) {
        for (int u = x; u >= 0 && u < size_of(row); u += step) {
          if (!known[at(u)]) continue;
          least = least ? std::min(*least, known[at(u)]->units) : known[at(u)]->units;
          return;
        }
      };
      look(-1);
      look(1);
      if (least) row[at(x)] = Value{*least, true};
    }
  }

  // --- 5: from the grid to the image

  /// The steps are those in gray values to the two.
  static std::optional<Value> between(std::optional<Value> a, int step_to_a, std::optional<Value> b,
                                      int step_to_b) {
    if (!a || !b) return a ? a : b;
    if (std::abs(a->units - b->units) < kNear)
      return Value{(a->units + b->units) / 2, a->filled || b->filled};
    if (step_to_a != step_to_b) return step_to_a < step_to_b ? a : b;
    return a->units < b->units ? a : b;
  }

  int gray_step(int x, int y, int to_x, int to_y) const {
    return std::abs(pixel(left_, x, y) - pixel(left_, to_x, to_y));
  }

  std::optional<Value> value_in_row(const std::vector<ValueRow>& grid, int x, int grid_y) const {
    const ValueRow& row = grid[at(grid_y)];
    const int left = x / column_step_;
    if (x % column_step_ == 0) return row[at(left)];
    const int y = image_row(grid_y);
    return between(row[at(left)], gray_step(x, y, x - 1, y), row[at(std::min(left + 1, grid_width_ - 1))],
                   gray_step(x, y, x + 1, y));
  }

  std::optional<Value> value_at(const std::vector<ValueRow>& grid, int x, int y) const {
    const std::optional<Value> upper = value_in_row(grid, x, y / 2);
    if (y % 2 == 0) return upper;
    return between(upper, gray_step(x, y, x, y - 1),
                   value_in_row(grid, x, std::min(y / 2 + 1, grid_height_ - 1)), gray_step(x, y, x, y + 1));
  }

  std::int16_t output(std::optional<Value> value, int x, int y) const {
    if (!value || (left_mask_ != nullptr && left_mask_->row(y)[x] == 0)) return kInvalidDisparity;
    const int whole = (value->units + 8) / 16;
    const int match = match_of(x, whole);
    const bool has_match = match >= 0 && (right_mask_ == nullptr || right_mask_->row(y)[match] != 0);
    if (!value->filled && !has_match && !options_.hole_filling) return kInvalidDisparity;
    const auto disparity = static_cast<std::int16_t>(
        options_.subpixel ? 16 * options_.min_disparity + value->units : options_.min_disparity + whole);
    return value->filled || !has_match ? as_filled(disparity) : disparity;
  }

  GrayView left_, right_;
  const MatcherOptions& options_;
  const ValidityMask* left_mask_;
  const ValidityMask* right_mask_;
  int column_step_;
  int grid_width_, grid_height_;
};

}  // namespace

DisparityImage semiglobal_by_definition(GrayView left, GrayView right, const MatcherOptions& options,
                                        const ValidityMask* left_mask, const ValidityMask* right_mask) {
  return Reference(left, right, options, left_mask, right_mask).match();
}

}  // namespace stereod
