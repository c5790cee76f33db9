// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/matcher_oracle.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

namespace stereod {
namespace {

/// The result of the search at one pixel (section 2).
struct Search {
  std::vector<std::int64_t> costs;  ///< C(k) for k in [0, n)
  int winner = 0;

  int n() const { return static_cast<int>(costs.size()); }
  std::int64_t cost(int k) const { return costs[static_cast<std::size_t>(k)]; }
  std::int64_t winning_cost() const { return cost(winner); }
};

/// One image row; nullopt where a pixel has no disparity.
using SearchedRow = std::vector<std::optional<Search>>;

int radius_of(const MatcherOptions& options) { return (options.window - 1) / 2; }

std::int64_t window_cost(const Image<int>& left, const Image<int>& right, int x, int y, int d,
                         const MatcherOptions& options) {
  const int r = radius_of(options);
  std::int64_t sum = 0;
  std::int64_t sum_of_squares = 0;
  std::int64_t maximum = 0;
  for (int j = -r; j <= r; ++j) {
    for (int i = -r; i <= r; ++i) {
      const std::int64_t difference = std::abs(left.at(x + i, y + j) - right.at(x - d + i, y + j));
      sum += difference;
      sum_of_squares += difference * difference;
      maximum = std::max(maximum, difference);
    }
  }
  switch (options.cost) {
    case Cost::kSad:
      return sum;
    case Cost::kSsd:
      return sum_of_squares;
    case Cost::kMad:
      return maximum;
  }
  std::abort();
}

std::optional<Search> search(const Image<int>& left, const Image<int>& right, int x, int y,
                             const MatcherOptions& options) {
  const int r = radius_of(options);
  const int min = options.min_disparity;
  const bool window_in_left = r <= x && x < left.width() - r && r <= y && y < left.height() - r;
  const bool first_window_in_right = x - min - r >= 0;
  if (!window_in_left || !first_window_in_right) return std::nullopt;

  Search found;
  const int n = std::min(options.disparities, x - min - r + 1);
  for (int k = 0; k < n; ++k) found.costs.push_back(window_cost(left, right, x, y, min + k, options));
  for (int k = 1; k < n; ++k) {
    if (found.cost(k) < found.winning_cost()) found.winner = k;
  }
  return found;
}

/// Returns @p numerator / @p denominator [> 0], rounded to the nearest integer, halves away from zero.
std::int64_t rounded_quotient(std::int64_t numerator, std::int64_t denominator) {
  const std::int64_t size = (2 * std::abs(numerator) + denominator) / (2 * denominator);
  return numerator < 0 ? -size : size;
}

/// Section 3.
std::int16_t value_of(const Search& found, const MatcherOptions& options) {
  const int k = found.winner;
  const int d = options.min_disparity + k;
  if (!options.subpixel) return static_cast<std::int16_t>(d);
  std::int64_t f = 0;
  if (k > 0 && k < found.n() - 1) {
    const std::int64_t m = found.cost(k);
    const std::int64_t a = found.cost(k - 1);
    const std::int64_t b = found.cost(k + 1);
    if (std::max(a, b) != m) f = rounded_quotient(8 * (a - b), std::max(a, b) - m);
  }
  return static_cast<std::int16_t>(std::int64_t{16} * d + f);
}

/// Section 4, `texture_threshold`.
bool fails_texture(const Image<int>& left, int x, int y, const MatcherOptions& options) {
  if (options.texture_threshold <= 0) return false;
  const int r = radius_of(options);
  std::int64_t sum = 0;
  for (int j = -r; j <= r; ++j) {
    for (int i = -r; i <= r; ++i) sum += std::abs(left.at(x + i, y + j) - options.prefilter_cap);
  }
  return sum < options.texture_threshold;
}

/// Section 4, `uniqueness_ratio`.
bool fails_uniqueness(const Search& found, const MatcherOptions& options) {
  if (options.uniqueness_ratio <= 0) return false;
  const std::int64_t m = found.winning_cost();
  for (int rival = 0; rival < found.n(); ++rival) {
    const bool beside = std::abs(rival - found.winner) <= 1;
    if (!beside && found.cost(rival) <= m + m * options.uniqueness_ratio / 100) return true;
  }
  return false;
}

/// Section 4, `left_right_max_diff`: searches the whole row for the best match.
bool fails_left_right(const SearchedRow& row, int x, const MatcherOptions& options) {
  if (options.left_right_max_diff < 0) return false;
  const Search& mine = *row[static_cast<std::size_t>(x)];
  const int right_pixel = x - options.min_disparity - mine.winner;
  const Search* best = nullptr;
  for (int other_x = 0; other_x < static_cast<int>(row.size()); ++other_x) {
    const std::optional<Search>& other = row[static_cast<std::size_t>(other_x)];
    if (!other || other_x - options.min_disparity - other->winner != right_pixel) continue;
    if (best == nullptr || other->winning_cost() < best->winning_cost()) best = &*other;
  }
  return std::abs(best->winner - mine.winner) > options.left_right_max_diff;
}

}  // namespace

Image<int> oracle_prefilter(GrayView image, const MatcherOptions& options) {
  const int width = image.width();
  const int height = image.height();
  Image<int> result(width, height);
  const auto mirrored = [height](int y) {
    if (height == 1) return 0;
    if (y < 0) return -y;
    if (y >= height) return 2 * (height - 1) - y;
    return y;
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (options.prefilter == Prefilter::kNone) {
        result.at(x, y) = image.at(x, y);
        continue;
      }
      const int cap = options.prefilter_cap;
      if (x == 0 || x == width - 1) {
        result.at(x, y) = cap;
        continue;
      }
      const auto s = [&](int v) { return image.at(x + 1, mirrored(v)) - image.at(x - 1, mirrored(v)); };
      const int g = s(y - 1) + 2 * s(y) + s(y + 1);
      result.at(x, y) = std::clamp(g, -cap, cap) + cap;
    }
  }
  return result;
}

DisparityImage oracle_median(const DisparityImage& disparities, int side) {
  DisparityImage result(disparities.size());
  const int r = (side - 1) / 2;
  for (int y = 0; y < disparities.height(); ++y) {
    for (int x = 0; x < disparities.width(); ++x) {
      result.at(x, y) = kInvalidDisparity;
      if (disparities.at(x, y) == kInvalidDisparity) continue;
      std::vector<std::int16_t> valid;
      for (int v = std::max(0, y - r); v <= std::min(disparities.height() - 1, y + r); ++v) {
        for (int u = std::max(0, x - r); u <= std::min(disparities.width() - 1, x + r); ++u) {
          if (disparities.at(u, v) != kInvalidDisparity) valid.push_back(disparities.at(u, v));
        }
      }
      std::sort(valid.begin(), valid.end());
      result.at(x, y) = valid[(valid.size() - 1) / 2];
    }
  }
  return result;
}

namespace {

/// Measured or filled in.
int disparity_of(std::int16_t value) { return value < -1 ? -2 - value : value; }

}  // namespace

DisparityImage oracle_speckle(const DisparityImage& disparities, int speckle_size,
                              int max_difference_in_units) {
  using Point = std::pair<int, int>;
  const int width = disparities.width();
  const int height = disparities.height();
  DisparityImage result(disparities.size());
  copy_pixels(disparities.view(), result.view());
  Image<std::uint8_t> visited(disparities.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (visited.at(x, y) || disparities.at(x, y) == kInvalidDisparity) continue;
      // The list grows during the iteration, until it holds the whole region.
      std::vector<Point> region = {{x, y}};
      visited.at(x, y) = 1;
      for (std::size_t i = 0; i < region.size(); ++i) {
        const auto [px, py] = region[i];
        const Point neighbors[] = {{px, py - 1}, {px, py + 1}, {px - 1, py}, {px + 1, py}};
        for (const auto& [qx, qy] : neighbors) {
          if (qx < 0 || qx >= width || qy < 0 || qy >= height || visited.at(qx, qy)) continue;
          if (disparities.at(qx, qy) == kInvalidDisparity) continue;
          const int step =
              std::abs(disparity_of(disparities.at(px, py)) - disparity_of(disparities.at(qx, qy)));
          if (step > max_difference_in_units) continue;
          visited.at(qx, qy) = 1;
          region.emplace_back(qx, qy);
        }
      }
      if (static_cast<int>(region.size()) > speckle_size) continue;
      for (const auto& [px, py] : region) result.at(px, py) = kInvalidDisparity;
    }
  }
  return result;
}

DisparityImage oracle_match(GrayView left_image, GrayView right_image, const MatcherOptions& options) {
  const Image<int> left = oracle_prefilter(left_image, options);
  const Image<int> right = oracle_prefilter(right_image, options);
  DisparityImage result(left.size());
  for (int y = 0; y < left.height(); ++y) {
    SearchedRow row;
    for (int x = 0; x < left.width(); ++x) row.push_back(search(left, right, x, y, options));
    for (int x = 0; x < left.width(); ++x) {
      const std::optional<Search>& found = row[static_cast<std::size_t>(x)];
      const bool valid = found && !fails_texture(left, x, y, options) && !fails_uniqueness(*found, options) &&
                         !fails_left_right(row, x, options);
      result.at(x, y) = valid ? value_of(*found, options) : kInvalidDisparity;
    }
  }
  if (options.median > 0) result = oracle_median(result, options.median);
  if (options.speckle_size > 0) {
    result =
        oracle_speckle(result, options.speckle_size, options.speckle_max_diff * options.units_per_pixel());
  }
  return result;
}

}  // namespace stereod
