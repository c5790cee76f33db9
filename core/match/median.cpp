// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/median.h"

#include <array>
#include <cstring>
#include <limits>

#include "core/match/disparity.h"

namespace stereod {
namespace {

// Pixels of one vector. Every supported CPU has vectors of 16 bytes.
constexpr int kColumns = 8;
using Values [[gnu::vector_size(2 * kColumns)]] = std::int16_t;
static_assert(kColumns + 4 <= kMedianMargin);

Values load(const std::int16_t* p) {
  Values values;
  std::memcpy(&values, p, sizeof(values));
  return values;
}

struct Comparator {
  int low, high;
};

// Visits the comparators that sort N values: Batcher's odd-even merge sort (Knuth, TAOCP 3, 5.2.2, algorithm
// M).
template <int kN, typename Visit>
constexpr void visit_comparators(Visit visit) {
  for (int p = 1; p < kN; p += p) {
    for (int k = p; k >= 1; k /= 2) {
      for (int j = k % p; j <= kN - 1 - k; j += 2 * k) {
        for (int i = j; i < j + k && i + k < kN; ++i) {
          if (i / (2 * p) == (i + k) / (2 * p)) visit(Comparator{i, i + k});
        }
      }
    }
  }
}

template <int kN>
constexpr auto sorting_network() {
  constexpr int kCount = [] {
    int count = 0;
    visit_comparators<kN>([&](Comparator) { ++count; });
    return count;
  }();
  std::array<Comparator, kCount> network{};
  int next = 0;
  visit_comparators<kN>(
      [&](Comparator comparator) { network[static_cast<std::size_t>(next++)] = comparator; });
  return network;
}

// Filters kColumns pixels from column x on. Invalid pixels sort to the end, so the median of v valid ones is
// at index (v − 1) / 2.
template <int kRadius>
void median_block(const std::int16_t* const* rows, int x, std::int16_t* out) {
  constexpr int kSide = 2 * kRadius + 1;
  constexpr int kN = kSide * kSide;
  static constexpr auto kNetwork = sorting_network<kN>();
  const Values invalid = Values{} + kInvalidDisparity;
  const Values last = Values{} + std::numeric_limits<std::int16_t>::max();
  Values values[kN];
  Values valid_count{};
#pragma GCC unroll 25
  for (int n = 0; n < kN; ++n) {
    const Values in = load(rows[n / kSide] + x + n % kSide - kRadius);
    values[n] = in != invalid ? in : last;
    valid_count -= in != invalid;  // a true lane is −1
  }
#pragma GCC unroll 256
  for (const Comparator& comparator : kNetwork) {
    const Values a = values[comparator.low];
    const Values b = values[comparator.high];
    values[comparator.low] = a < b ? a : b;
    values[comparator.high] = a < b ? b : a;
  }
  Values result = values[0];
#pragma GCC unroll 25
  for (int middle = 1; middle <= (kN - 1) / 2; ++middle) {
    result = valid_count > Values{} + static_cast<std::int16_t>(2 * middle) ? values[middle] : result;
  }
  result = load(rows[kRadius] + x) != invalid ? result : invalid;
  std::memcpy(out + x, &result, sizeof(result));
}

}  // namespace

void median_row(const std::int16_t* const* rows, int width, int radius, std::int16_t* out) noexcept {
  for (int x = 0; x < width; x += kColumns) {
    if (radius == 1) {
      median_block<1>(rows, x, out);
    } else {
      median_block<2>(rows, x, out);
    }
  }
}

}  // namespace stereod
