#include "core/match/row_filters.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "core/match/interpolation.h"

namespace stereod {
namespace {

std::size_t at(int x) { return static_cast<std::size_t>(x); }

struct Baseline {};

template <typename Real>
void write_subpixel(const RowWinners& winners, const MatcherOptions& options, std::int16_t* out) {
  const std::size_t first = at(winners.first);
  interpolate<Real, Baseline>(winners.index.data() + first, winners.cost.data() + first,
                              winners.before.data() + first, winners.after.data() + first,
                              winners.end - winners.first, options.min_disparity, options.disparities,
                              out + first);
}

}  // namespace

void write_disparities(const RowWinners& winners, const MatcherOptions& options, std::int16_t* out) noexcept {
  if (!options.subpixel) {
    for (int x = winners.first; x < winners.end; ++x) {
      out[x] = static_cast<std::int16_t>(options.min_disparity + winners.index[at(x)]);
    }
  } else if (options.cost == Cost::kSad) {
    write_subpixel<float>(winners, options, out);  // costs stay below 2^18
  } else {
    write_subpixel<double>(winners, options, out);
  }
}

void reject_ambiguous(const RowWinners& winners, std::int16_t* out) noexcept {
  const std::uint8_t* ambiguous = winners.ambiguous.data();
  for (int x = winners.first; x < winners.end; ++x) {
    // Without a branch: kInvalidDisparity has all bits set.
    static_assert(kInvalidDisparity == -1);
    out[x] = static_cast<std::int16_t>(out[x] | -ambiguous[x]);
  }
}

void reject_left(const RowWinners& winners, const std::uint8_t* valid, std::int16_t* out) noexcept {
  for (int x = winners.first; x < winners.end; ++x) {
    out[x] = static_cast<std::int16_t>(out[x] | (valid[x] - 1));  // 1 leaves it, 0 sets all bits
  }
}

void reject_right(const RowWinners& winners, int min_disparity, const std::uint8_t* valid,
                  std::int16_t* out) noexcept {
  for (int x = winners.first; x < winners.end; ++x) {
    const int match = x - min_disparity - winners.index[at(x)];
    out[x] = static_cast<std::int16_t>(out[x] | (valid[match] - 1));
  }
}

LeftRightCheck::LeftRightCheck(int width) : claims_(at(width)) {}

void LeftRightCheck::reject(const RowWinners& winners, const MatcherOptions& options,
                            std::int16_t* out) noexcept {
  if (options.cost == Cost::kSad) {  // costs stay below 2^18, k below 2^8
    reject_by(reinterpret_cast<std::uint32_t*>(claims_.data()), winners, options, out);
  } else {
    reject_by(claims_.data(), winners, options, out);
  }
}

// A claim is cost and k in one number. Of the left pixels that claim the same right one, the lowest x has the
// lowest k, so the least number is the claim that stands.
template <typename Claim>
void LeftRightCheck::reject_by(Claim* claims, const RowWinners& winners, const MatcherOptions& options,
                               std::int16_t* out) {
  constexpr int kIndexBits = 8;
  std::fill_n(claims, claims_.size(), std::numeric_limits<Claim>::max());
  const std::uint16_t* index = winners.index.data() + winners.first;
  const std::uint32_t* cost = winners.cost.data() + winners.first;
  Claim* first = claims + winners.first - options.min_disparity;  // what k = 0 claims in the first column
  const std::ptrdiff_t count = winners.end - winners.first;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Claim claim = Claim{cost[i]} << kIndexBits | index[i];
    Claim& standing = first[i - index[i]];
    standing = claim < standing ? claim : standing;
  }
  const auto max_diff = static_cast<unsigned>(options.left_right_max_diff);
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const int standing = static_cast<int>(first[i - index[i]] & ((1U << kIndexBits) - 1));
    // |difference| > max_diff, in one comparison.
    const bool differs = static_cast<unsigned>(standing - index[i]) + max_diff > 2 * max_diff;
    out[winners.first + i] = static_cast<std::int16_t>(out[winners.first + i] | -static_cast<int>(differs));
  }
}

std::size_t LeftRightCheck::scratch_bytes() const noexcept { return claims_.size() * sizeof(claims_[0]); }

TextureCheck::TextureCheck(int width) : column_sums_(at(width)) {}

void TextureCheck::reset() noexcept { column_sums_.fill_zero(); }

void TextureCheck::add_row(const std::uint8_t* added, const std::uint8_t* removed, int cap) noexcept {
  const int width = static_cast<int>(column_sums_.size());
  std::uint16_t* sums = column_sums_.data();
  const auto middle = static_cast<std::int16_t>(cap);
  const auto gradient = [middle](std::uint8_t value) {
    return static_cast<std::uint16_t>(std::abs(static_cast<std::int16_t>(value - middle)));
  };
  if (removed == nullptr) {
    for (int x = 0; x < width; ++x) sums[x] = static_cast<std::uint16_t>(sums[x] + gradient(added[x]));
  } else {
    for (int x = 0; x < width; ++x) {
      sums[x] = static_cast<std::uint16_t>(sums[x] + gradient(added[x]) - gradient(removed[x]));
    }
  }
}

void TextureCheck::reject(const RowWinners& winners, const MatcherOptions& options,
                          std::int16_t* out) noexcept {
  const int r = options.window / 2;
  const std::uint16_t* leaving = column_sums_.data() + winners.first - r;
  const std::uint16_t* coming = leaving + options.window - 1;
  const int threshold = options.texture_threshold;
  int sum = 0;
  for (int i = 0; i < options.window - 1; ++i) sum += leaving[i];
  for (int x = winners.first; x < winners.end; ++x) {
    sum += *coming++;
    if (sum < threshold) out[x] = kInvalidDisparity;
    sum -= *leaving++;
  }
}

std::size_t TextureCheck::scratch_bytes() const noexcept {
  return column_sums_.size() * sizeof(column_sums_[0]);
}

}  // namespace stereod
