#include "core/match/row_filters.h"

#include <algorithm>
#include <cstdlib>

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

void reject_ambiguous(const RowWinners& winners, int uniqueness_ratio, std::int16_t* out) noexcept {
  const std::uint32_t* cost = winners.cost.data();
  const std::uint32_t* rival = winners.rival.data();
  const auto percent = static_cast<std::uint32_t>(uniqueness_ratio);
  for (int x = winners.first; x < winners.end; ++x) {
    // rival ≤ cost + cost·percent/100 without the division; a rival is never below the cost.
    const std::uint64_t lead = std::uint64_t{100} * (rival[x] - cost[x]);
    const std::uint64_t allowed = std::uint64_t{percent} * cost[x];
    out[x] = lead <= allowed ? kInvalidDisparity : out[x];
  }
}

LeftRightCheck::LeftRightCheck(int width) : claims_(at(width)) {}

// A claim is cost and k in one number. Of the left pixels that claim the same right one, the lowest x has the
// lowest k, so the least number is the claim that stands.
void LeftRightCheck::reject(const RowWinners& winners, const MatcherOptions& options,
                            std::int16_t* out) noexcept {
  std::fill(claims_.begin(), claims_.end(), std::numeric_limits<std::uint64_t>::max());
  const std::uint16_t* index = winners.index.data();
  const std::uint32_t* cost = winners.cost.data();
  std::uint64_t* claims = claims_.data();
  const int min_disparity = options.min_disparity;
  const int max_diff = options.left_right_max_diff;
  const int end = winners.end;
  for (int x = winners.first; x < end; ++x) {
    const std::uint64_t claim = std::uint64_t{cost[x]} << 16 | index[x];
    std::uint64_t& standing = claims[x - min_disparity - index[x]];
    standing = claim < standing ? claim : standing;
  }
  for (int x = winners.first; x < end; ++x) {
    const int standing = static_cast<int>(claims[x - min_disparity - index[x]] & 0xFFFF);
    out[x] = std::abs(standing - index[x]) > max_diff ? kInvalidDisparity : out[x];
  }
}

std::size_t LeftRightCheck::scratch_bytes() const noexcept { return claims_.size() * sizeof(claims_[0]); }

TextureCheck::TextureCheck(int width) : column_sums_(at(width)) {}

void TextureCheck::reset() noexcept { column_sums_.fill_zero(); }

void TextureCheck::add_row(const std::uint8_t* added, const std::uint8_t* removed, int cap) noexcept {
  const int width = static_cast<int>(column_sums_.size());
  for (int x = 0; x < width; ++x) column_sums_[at(x)] += std::abs(added[x] - cap);
  if (removed == nullptr) return;
  for (int x = 0; x < width; ++x) column_sums_[at(x)] -= std::abs(removed[x] - cap);
}

void TextureCheck::reject(const RowWinners& winners, const MatcherOptions& options,
                          std::int16_t* out) noexcept {
  const int r = options.window / 2;
  std::int32_t sum = 0;
  for (int x = winners.first - r; x < winners.first + r; ++x) sum += column_sums_[at(x)];
  for (int x = winners.first; x < winners.end; ++x) {
    sum += column_sums_[at(x + r)];
    if (sum < options.texture_threshold) out[x] = kInvalidDisparity;
    sum -= column_sums_[at(x - r)];
  }
}

std::size_t TextureCheck::scratch_bytes() const noexcept {
  return column_sums_.size() * sizeof(column_sums_[0]);
}

}  // namespace stereod
