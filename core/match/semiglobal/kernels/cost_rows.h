// SPDX-License-Identifier: BSD-3-Clause
// Costs: how well the pixels of a row match those of the other image (docs/matcher.md, section 2.1).
#pragma once

#include <cstdint>

#include "core/match/semiglobal/kernels/kernel.h"

namespace stereod::semiglobal {

/// Describes rows of pixels for the comparison.
template <typename V>
class CensusRows {
  using Reg = typename V::Reg;

 public:
  /// Kernel::census_row.
  static void row(const std::uint8_t* const* rows, int row_bytes, int shift, std::uint8_t* out) {
    for (int nibble = 0; nibble < 2; ++nibble) {
      const std::uint8_t* first[4];
      const std::uint8_t* second[4];
      Reg bits[4];
      for (int i = 0; i < 4; ++i) {
        const int dx = kFirst[4 * nibble + i][0];
        const int dy = kFirst[4 * nibble + i][1];
        first[i] = rows[kCensusReach + dy] + dx;
        second[i] = rows[kCensusReach - dy] - dx;
        bits[i] = V::broadcast8(static_cast<std::uint8_t>(1 << (i + shift)));
      }
      for (int x = 0; x < row_bytes; x += V::kBytes) {
        const auto bit = [&](int i) {
          return V::bit_and(V::less_equal8(V::load(first[i] + x), V::load(second[i] + x)), bits[i]);
        };
        V::store(out + nibble * row_bytes + x,
                 V::bit_or(V::bit_or(bit(0), bit(1)), V::bit_or(bit(2), bit(3))));
      }
    }
  }

  /// Kernel::stripe_row.
  static void stripe(const SearchParams& params, const std::uint8_t* plane, std::uint8_t* scratch,
                     std::uint8_t* out) {
    const int length = params.row_bytes();
    const int stripe = params.stripe_bytes();
    std::uint8_t* const reversed = params.vectors == 1 ? out : scratch;
    for (int i = 0; i < length; i += 16) V::reverse16(plane + length - 16 - i, reversed + i);
    switch (params.vectors) {
      case 1:
        return;
      case 2:
        return split(reversed, length, out, out + stripe);
      case 4: {
        std::uint8_t* const even = scratch + length;
        std::uint8_t* const odd = even + length / 2;
        split(reversed, length, even, odd);
        split(even, length / 2, out, out + 2 * stripe);
        return split(odd, length / 2, out + stripe, out + 3 * stripe);
      }
      default:
        for (int k = 0; k < params.vectors; ++k) {
          for (int i = k, j = 0; i < length; i += params.vectors, ++j) out[k * stripe + j] = reversed[i];
        }
    }
  }

 private:
  // Offsets of the first pixel of each of the eight pairs; the second one lies opposite.
  static constexpr int kFirst[8][2] = {{-1, -1}, {0, -1},  {1, -1}, {-1, 0},
                                       {-2, 0},  {-2, -2}, {0, -2}, {2, -2}};

  static void split(const std::uint8_t* in, int length, std::uint8_t* even, std::uint8_t* odd) {
    for (int i = 0; i < length; i += 32) V::split32(in + i, even + i / 2, odd + i / 2);
  }
};

/// Kernel::cost_row. Passes over the row once for every two vectors of disparities, so that the values
/// carried from column to column stay in registers: some CPUs have only 16.
template <typename V>
class CostRows {
  using Reg = typename V::Reg;

 public:
  static void row(const SearchParams& params, const CostRow& row) {
    const Fixed fixed(params, row);
    params.decimation_x == 1 ? all_vectors<true>(fixed) : all_vectors<false>(fixed);
  }

 private:
  // What is the same for all pixels of a row. A copy, because for the compiler a stored byte may alias a
  // SearchParams or a CostRow: it would reload, and divide, for every pixel.
  struct Fixed {
    Fixed(const SearchParams& params, const CostRow& row)
        : vectors(params.vectors),
          last(params.width - 1),
          row_bytes(params.row_bytes()),
          plane(params.vectors * params.stripe_bytes()),
          left(row.left),
          right(row.right),
          tables(row.tables),
          offsets(row.offsets),
          costs(row.costs),
          limit(V::broadcast8(static_cast<std::uint8_t>(params.gradient_limit))) {}
    const int vectors;
    const std::ptrdiff_t last, row_bytes, plane;
    const std::uint8_t *const left, *const right, *const tables;
    const std::int32_t* const offsets;
    std::uint8_t* const costs;
    const Reg limit;
  };

  template <bool kEveryColumn>
  static void all_vectors(const Fixed& fixed) {
    int k = 0;
    for (; k + 2 <= fixed.vectors; k += 2) smooth<kEveryColumn, 2>(fixed, k);
    if (k < fixed.vectors) smooth<kEveryColumn, 1>(fixed, k);
  }

  // Smooths kGroup vectors from number `first` on, by averages: p(x) of the costs at x − 1 and x, q(x) of
  // p(x) and p(x − 2), and the result at x of q(x + 1) and q(x + 2), which weights the five costs 1 2 2 2 1.
  // Each iteration takes an odd and an even column.
  template <bool kEveryColumn, int kGroup>
  static void smooth(const Fixed& given, int first) {
    const Fixed fixed = given;  // a local copy, which no pointer aliases
    const std::ptrdiff_t sample = fixed.vectors * V::kBytes;
    Reg even[kGroup], odd[kGroup];            // costs
    Reg even_pair[kGroup], odd_pair[kGroup];  // p
    Reg quad[kGroup];                         // q of the even column before
    costs_at<kGroup>(fixed, first, 0, even);
#pragma GCC unroll 2
    for (int k = 0; k < kGroup; ++k) even_pair[k] = odd_pair[k] = quad[k] = even[k];
    std::uint8_t* out = fixed.costs + first * V::kBytes;  // of column x − 1
    const std::ptrdiff_t end = kEveryColumn ? fixed.last + 2 : fixed.last + 1;
    for (std::ptrdiff_t x = 1; x <= end; x += 2, out += kEveryColumn ? 2 * sample : sample) {
      costs_at<kGroup>(fixed, first, x, odd);
#pragma GCC unroll 2
      for (int k = 0; k < kGroup; ++k) {
        const Reg pair = V::average8(even[k], odd[k]);
        even[k] = V::average8(odd_pair[k], pair);  // q(x); overwrites costs that are no longer needed
        odd_pair[k] = pair;
        if constexpr (kEveryColumn)
          V::store_aligned(out - sample + k * V::kBytes, V::average8(quad[k], even[k]));
      }
      Reg next[kGroup];
      costs_at<kGroup>(fixed, first, x + 1, next);
#pragma GCC unroll 2
      for (int k = 0; k < kGroup; ++k) {
        const Reg pair = V::average8(odd[k], next[k]);
        const Reg next_quad = V::average8(even_pair[k], pair);
        V::store_aligned(out + k * V::kBytes, V::average8(even[k], next_quad));
        even_pair[k] = pair;
        even[k] = next[k];
        quad[k] = next_quad;
      }
    }
  }

  // Computes the costs of a pixel and its matches. Census: the left nibble chooses a table, the right nibbles
  // are looked up in it.
  template <int kGroup>
  [[gnu::always_inline]] static void costs_at(const Fixed& fixed, int first, std::ptrdiff_t x, Reg* costs) {
    const std::int32_t* const offsets = fixed.offsets + x * fixed.vectors + first;
    const std::uint8_t* const left = fixed.left + x;
    const Reg upper = V::load_table(fixed.tables + left[0]);
    const Reg lower = V::load_table(fixed.tables + left[fixed.row_bytes]);
    const Reg gradient = V::broadcast8(left[2 * fixed.row_bytes]);
#pragma GCC unroll 2
    for (int k = 0; k < kGroup; ++k) {
      const std::uint8_t* const right = fixed.right + offsets[k];
      const Reg census = V::add8(V::table_lookup(upper, V::load(right)),
                                 V::table_lookup(lower, V::load(right + fixed.plane)));
      const Reg step = V::abs_diff_small(gradient, V::load(right + 2 * fixed.plane));
      costs[k] = V::add8(census, V::min8(step, fixed.limit));
    }
  }
};

}  // namespace stereod::semiglobal
