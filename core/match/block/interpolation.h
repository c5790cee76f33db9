// SPDX-License-Identifier: BSD-3-Clause
// Interpolation between whole disparities: one loop, compiled for each instruction set.
#pragma once

#include <cstdint>

namespace stereod {

/// Writes 16·d + f [1/16 px] for @p count columns (docs/matcher.md, section 3). In the first column one
/// disparity is searched, in the next one two, up to @p disparities. @p index, @p cost, @p before and @p
/// after are as in RowWinners.
///
/// Real must hold 8 · cost exactly: float if that is below 2^24, else double. The result equals that of
/// integer arithmetic, because a quotient of such numbers that is not a half is too far from one to be
/// rounded to it; unlike integer division, vectors can compute it. Tag gives each differently compiled file
/// an instantiation of its own. No std:: functions here, see kernels/kernel-inl.h.
template <typename Real, typename Tag>
void interpolate(const std::uint16_t* __restrict index, const std::uint32_t* __restrict cost,
                 const std::uint32_t* __restrict before, const std::uint32_t* __restrict after, int count,
                 int min_disparity, int disparities, std::int16_t* __restrict out) {
  for (int i = 0; i < count; ++i) {
    const int k = index[i];
    const int last = i < disparities - 1 ? i : disparities - 1;
    const auto a = static_cast<std::int32_t>(before[i]);
    const auto b = static_cast<std::int32_t>(after[i]);
    const std::int32_t height = (a > b ? a : b) - static_cast<std::int32_t>(cost[i]);
    const std::int32_t rise = 8 * (a - b);
    // An integer condition, which compiles without a branch.
    const auto rounding = static_cast<Real>(rise < 0 ? -1 : 1) / 2;
    const Real offset = static_cast<Real>(rise) / static_cast<Real>(height > 0 ? height : 1) + rounding;
    // An integer mask: with a condition the compiler would move the conversion behind a branch.
    const std::int32_t inside = -static_cast<std::int32_t>((k > 0) & (k < last));
    out[i] =
        static_cast<std::int16_t>(16 * (min_disparity + k) + (static_cast<std::int32_t>(offset) & inside));
  }
}

}  // namespace stereod
