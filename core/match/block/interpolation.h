// Interpolation between whole disparities, as one loop that every instruction set compiles for itself.
#pragma once

#include <cstdint>

namespace stereod {

/// Writes 16·d + f for `count` columns whose first has one disparity to search, the next two, up to
/// `disparities` (docs/matcher.md, section 3). Index, cost, before and after as in RowWinners. Real is float
/// if eight times every cost is below 2^24, else double: it holds them exactly, and a quotient of such
/// numbers that is not a half is too far from one to be rounded to it, so the result is that of integer
/// arithmetic, but vectors can do it. Tag keeps the instantiations of differently compiled files apart. No
/// std:: functions here, see kernel_template.h.
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
    const auto rounding =
        static_cast<Real>(rise < 0 ? -1 : 1) / 2;  // chosen by an integer: that becomes no branch
    const Real offset = static_cast<Real>(rise) / static_cast<Real>(height > 0 ? height : 1) + rounding;
    // An integer mask, not a condition: the compiler would move the conversion behind a branch.
    const std::int32_t inside = -static_cast<std::int32_t>((k > 0) & (k < last));
    out[i] =
        static_cast<std::int16_t>(16 * (min_disparity + k) + (static_cast<std::int32_t>(offset) & inside));
  }
}

}  // namespace stereod
