// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/semiglobal/reference_costs.h"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace stereod::semiglobal {
namespace {

int average(int a, int b) { return (a + b + 1) / 2; }

// The gray value at (x, y), or at the nearest pixel of the image.
int pixel(GrayView image, int x, int y) {
  return image.at(std::clamp(x, 0, image.width() - 1), std::clamp(y, 0, image.height() - 1));
}

// Compares eight pairs of pixels on opposite sides of (x, y): one bit each, 1 where the first one is
// brighter.
int census(GrayView image, int x, int y) {
  constexpr std::array<std::array<int, 2>, 8> kFirst{
      {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {-2, 0}, {-2, -2}, {0, -2}, {2, -2}}};
  int bits = 0;
  for (const auto& [dx, dy] : kFirst) {
    bits = 2 * bits + (pixel(image, x + dx, y + dy) > pixel(image, x - dx, y - dy) ? 1 : 0);
  }
  return bits;
}

int gradient(GrayView image, int x, int y, int cap) {
  if (x == 0 || x == image.width() - 1) return 0;
  const auto mirrored = [height = image.height()](int row) {
    if (height == 1) return 0;
    return row < 0 ? -row : row >= height ? 2 * (height - 1) - row : row;
  };
  const auto step = [&](int row) { return image.at(x + 1, mirrored(row)) - image.at(x - 1, mirrored(row)); };
  return std::clamp(step(y - 1) + 2 * step(y) + step(y + 1), -cap, cap);
}

// Weights five neighbors by about 1 2 2 2 1.
int smoothed(int a, int b, int c, int d, int e) {
  return average(average(average(a, b), average(c, d)), average(average(b, c), average(d, e)));
}

// smoothed() around element i, for each k. Elements outside are the nearest ones.
Costs smoothed_at(const std::vector<const Costs*>& elements, int i) {
  const auto element = [&](int j) -> const Costs& {
    return *elements[as_index(std::clamp(j, 0, size_of(elements) - 1))];
  };
  Costs result(element(i).size());
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] =
        smoothed(element(i - 2)[k], element(i - 1)[k], element(i)[k], element(i + 1)[k], element(i + 2)[k]);
  }
  return result;
}

Costs costs_of_pixel(const SampledPair& pair, int x, int y) {
  const MatcherOptions& options = pair.options;
  Costs costs;
  for (int k = 0; k < options.disparities; ++k) {
    const int match = pair.match_of(x, k);
    if (match < 0) {
      costs.push_back(options.gradient_limit);
      continue;
    }
    const auto differing =
        static_cast<unsigned>(census(pair.left, x, y)) ^ static_cast<unsigned>(census(pair.right, match, y));
    const int step = std::abs(gradient(pair.left, x, y, options.prefilter_cap) -
                              gradient(pair.right, match, y, options.prefilter_cap));
    costs.push_back(options.census_weight * __builtin_popcount(differing) +
                    std::min(step, options.gradient_limit));
  }
  return costs;
}

CostsOfRow smoothed_along_row(const SampledPair& pair, int grid_y) {
  CostsOfRow pixels;
  for (int x = 0; x < pair.left.width(); ++x) {
    pixels.push_back(costs_of_pixel(pair, x, pair.image_row(grid_y)));
  }
  std::vector<const Costs*> elements;
  for (const Costs& costs : pixels) elements.push_back(&costs);
  CostsOfRow result;
  for (int grid_x = 0; grid_x < pair.grid_width; ++grid_x) {
    result.push_back(smoothed_at(elements, pair.column(grid_x)));
  }
  return result;
}

// What a path adds at a sample, for each k, if @p before are its sums at the sample before.
Costs carried(const Costs& before, int p1, int p2) {
  const int minimum = *std::min_element(before.begin(), before.end());
  Costs result(before.size());
  for (int k = 0; k < size_of(before); ++k) {
    int best = std::min(before[as_index(k)] - minimum, p2);
    if (k > 0) best = std::min(best, before[as_index(k - 1)] - minimum + p1);
    if (k + 1 < size_of(before)) best = std::min(best, before[as_index(k + 1)] - minimum + p1);
    result[as_index(k)] = best;
  }
  return result;
}

// The sums of the path that comes to each sample from the left (step 1) or from the right (step −1).
CostsOfRow path(const SampledPair& pair, const CostsOfRow& costs, int grid_y, int step) {
  CostsOfRow sums(costs.size());
  const int first = step > 0 ? 0 : pair.grid_width - 1;
  for (int i = 0, x = first; i < pair.grid_width; ++i, x += step) {
    sums[as_index(x)] = costs[as_index(x)];
    if (x == first) continue;
    const int y = pair.image_row(grid_y);
    const int gray_step = pair.gray_step(pair.column(x), y, pair.column(x - step), y);
    const Costs added =
        carried(sums[as_index(x - step)], pair.options.p1, std::max(0, pair.options.p2 - gray_step));
    for (std::size_t k = 0; k < added.size(); ++k) {
      sums[as_index(x)][k] = std::min(kMaxSum, costs[as_index(x)][k] + added[k]);
    }
  }
  return sums;
}

}  // namespace

int SampledPair::gray_step(int x, int y, int to_x, int to_y) const {
  return std::abs(pixel(left, x, y) - pixel(left, to_x, to_y));
}

std::vector<CostsOfRow> smoothed_costs(const SampledPair& pair) {
  std::vector<CostsOfRow> along;
  along.reserve(as_index(pair.grid_height));
  for (int row = 0; row < pair.grid_height; ++row) along.push_back(smoothed_along_row(pair, row));
  std::vector<CostsOfRow> result;
  for (int row = 0; row < pair.grid_height; ++row) {
    CostsOfRow smoothed_row;
    for (int grid_x = 0; grid_x < pair.grid_width; ++grid_x) {
      std::vector<const Costs*> elements;
      elements.reserve(along.size());
      for (const CostsOfRow& other : along) elements.push_back(&other[as_index(grid_x)]);
      smoothed_row.push_back(smoothed_at(elements, row));
    }
    result.push_back(smoothed_row);
  }
  return result;
}

CostsOfRow path_sums(const SampledPair& pair, const CostsOfRow& costs, int grid_y) {
  const CostsOfRow from_left = path(pair, costs, grid_y, 1);
  CostsOfRow sums = path(pair, costs, grid_y, -1);
  for (std::size_t x = 0; x < sums.size(); ++x) {
    for (std::size_t k = 0; k < sums[x].size(); ++k) {
      sums[x][k] = std::min(kMaxSum, sums[x][k] + from_left[x][k]);
    }
  }
  return sums;
}

}  // namespace stereod::semiglobal
