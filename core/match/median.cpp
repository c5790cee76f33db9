#include "core/match/median.h"

#include <array>
#include <limits>

#include "core/disparity.h"

namespace stereod {
namespace {

// Pixels done at once. All steps are plain loops over them, which the compiler turns into vector instructions.
constexpr int kColumns = 16;
using Values = std::array<std::int16_t, kColumns>;
static_assert(kColumns + 4 <= kMedianMargin);

struct Comparator {
  int low, high;
};

// The comparators that sort N values: Batcher's odd-even merge sort (Knuth, TAOCP 3, 5.2.2, algorithm M).
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
  visit_comparators<kN>([&](Comparator comparator) { network[static_cast<std::size_t>(next++)] = comparator; });
  return network;
}

void order(Values& low, Values& high) {
  for (std::size_t i = 0; i < kColumns; ++i) {
    const std::int16_t a = low[i];
    const std::int16_t b = high[i];
    low[i] = a < b ? a : b;
    high[i] = a < b ? b : a;
  }
}

// kColumns pixels from column x on. Invalid pixels sort to the end, so the middle of the v valid ones is at
// (v − 1) / 2.
template <int kRadius>
void median_block(const std::int16_t* const* rows, int x, std::int16_t* out) {
  constexpr int kSide = 2 * kRadius + 1;
  constexpr int kN = kSide * kSide;
  static constexpr auto kNetwork = sorting_network<kN>();
  std::array<Values, kN> values;
  Values valid{};
  for (int n = 0; n < kN; ++n) {
    const std::int16_t* in = rows[n / kSide] + x + n % kSide - kRadius;
    for (std::size_t i = 0; i < kColumns; ++i) {
      const bool is_valid = in[i] != kInvalidDisparity;
      values[static_cast<std::size_t>(n)][i] = is_valid ? in[i] : std::numeric_limits<std::int16_t>::max();
      valid[i] = static_cast<std::int16_t>(valid[i] + (is_valid ? 1 : 0));
    }
  }
  for (const Comparator& comparator : kNetwork) {
    order(values[static_cast<std::size_t>(comparator.low)], values[static_cast<std::size_t>(comparator.high)]);
  }
  Values result = values[0];
  for (std::int16_t place = 1; place <= (kN - 1) / 2; ++place) {
    const Values& candidate = values[static_cast<std::size_t>(place)];
    for (std::size_t i = 0; i < kColumns; ++i) result[i] = valid[i] > 2 * place ? candidate[i] : result[i];
  }
  const std::int16_t* center = rows[kRadius] + x;
  for (std::size_t i = 0; i < kColumns; ++i) out[x + static_cast<int>(i)] = center[i] == kInvalidDisparity ? kInvalidDisparity : result[i];
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
