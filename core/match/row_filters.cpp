#include "core/match/row_filters.h"

#include <algorithm>
#include <cstdlib>

namespace stereod {
namespace {

std::size_t at(int x) { return static_cast<std::size_t>(x); }

// Offset of the vertex of two lines of equal and opposite slope through three costs, in 1/16 px, −8…8.
// Doubles hold every number here exactly, and a quotient of such numbers that is not a half is too far from
// one to be rounded to it: the result is that of integer arithmetic, but vectors can do it.
double vertex_offset(std::int32_t before, std::int32_t cost, std::int32_t after) {
  const std::int32_t height = (before > after ? before : after) - cost;
  const double offset = 8.0 * (before - after) / (height > 0 ? height : 1);
  return offset < 0 ? offset - 0.5 : offset + 0.5;
}

}  // namespace

void write_disparities(const RowWinners& winners, const MatcherOptions& options, std::int16_t* out) noexcept {
  const int first = winners.first;
  if (!options.subpixel) {
    for (int x = first; x < winners.end; ++x) {
      out[x] = static_cast<std::int16_t>(options.min_disparity + winners.index[at(x)]);
    }
    return;
  }
  const std::uint16_t* index = winners.index.data();
  const std::uint32_t* cost = winners.cost.data();
  const std::uint32_t* before = winners.before.data();
  const std::uint32_t* after = winners.after.data();
  for (int x = first; x < winners.end; ++x) {
    const int k = index[x];
    const int last = options.disparities - 1 < x - first ? options.disparities - 1 : x - first;
    const auto offset = static_cast<std::int32_t>(vertex_offset(static_cast<std::int32_t>(before[x]),
                                                                static_cast<std::int32_t>(cost[x]),
                                                                static_cast<std::int32_t>(after[x])));
    const bool inside = (k > 0) & (k < last);
    out[x] = static_cast<std::int16_t>(kSubpixelUnits * (options.min_disparity + k) + (inside ? offset : 0));
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

LeftRightCheck::LeftRightCheck(int width) : claim_cost_(at(width)), claim_index_(at(width)) {}

void LeftRightCheck::reject(const RowWinners& winners, const MatcherOptions& options,
                            std::int16_t* out) noexcept {
  std::fill(claim_cost_.begin(), claim_cost_.end(), std::numeric_limits<std::uint32_t>::max());
  for (int x = winners.first; x < winners.end; ++x) {
    const std::size_t claimed = at(x - options.min_disparity - winners.index[at(x)]);
    if (winners.cost[at(x)] < claim_cost_[claimed]) {
      claim_cost_[claimed] = winners.cost[at(x)];
      claim_index_[claimed] = winners.index[at(x)];
    }
  }
  for (int x = winners.first; x < winners.end; ++x) {
    const int k = winners.index[at(x)];
    const int standing = claim_index_[at(x - options.min_disparity - k)];
    if (std::abs(standing - k) > options.left_right_max_diff) out[x] = kInvalidDisparity;
  }
}

std::size_t LeftRightCheck::scratch_bytes() const noexcept {
  return claim_cost_.size() * sizeof(claim_cost_[0]) + claim_index_.size() * sizeof(claim_index_[0]);
}

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
