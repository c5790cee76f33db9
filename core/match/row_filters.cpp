#include "core/match/row_filters.h"

#include <algorithm>
#include <cstdlib>

namespace stereod {
namespace {

std::size_t at(int x) { return static_cast<std::size_t>(x); }

// Offset of the vertex of two lines of equal and opposite slope through three costs, in 1/16 px, −8…8.
int vertex_offset(std::int64_t before, std::int64_t cost, std::int64_t after) {
  const std::int64_t height = std::max(before, after) - cost;
  if (height <= 0) return 0;
  const std::int64_t rise = 8 * (before - after);
  const std::int64_t magnitude = (2 * std::abs(rise) + height) / (2 * height);
  return static_cast<int>(rise < 0 ? -magnitude : magnitude);
}

}  // namespace

void write_disparities(const RowWinners& winners, const MatcherOptions& options, std::int16_t* out) noexcept {
  if (!options.subpixel) {
    for (int x = winners.first; x < winners.end; ++x) {
      out[x] = static_cast<std::int16_t>(options.min_disparity + winners.index[at(x)]);
    }
    return;
  }
  for (int x = winners.first; x < winners.end; ++x) {
    const int k = winners.index[at(x)];
    const int searched = std::min(options.disparities, x - winners.first + 1);
    const bool inside = k > 0 && k < searched - 1;
    const int offset =
        inside ? vertex_offset(winners.before[at(x)], winners.cost[at(x)], winners.after[at(x)]) : 0;
    out[x] = static_cast<std::int16_t>(kSubpixelUnits * (options.min_disparity + k) + offset);
  }
}

void reject_ambiguous(const RowWinners& winners, int uniqueness_ratio, std::int16_t* out) noexcept {
  for (int x = winners.first; x < winners.end; ++x) {
    const std::uint64_t cost = winners.cost[at(x)];
    const std::uint64_t limit = cost + cost * static_cast<std::uint64_t>(uniqueness_ratio) / 100;
    if (winners.rival[at(x)] != RowWinners::kNoRival && winners.rival[at(x)] <= limit) out[x] = kInvalidDisparity;
  }
}

LeftRightCheck::LeftRightCheck(int width) : claim_cost_(at(width)), claim_index_(at(width)) {}

void LeftRightCheck::reject(const RowWinners& winners, const MatcherOptions& options, std::int16_t* out) noexcept {
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

void TextureCheck::reject(const RowWinners& winners, const MatcherOptions& options, std::int16_t* out) noexcept {
  const int r = options.window / 2;
  std::int32_t sum = 0;
  for (int x = winners.first - r; x < winners.first + r; ++x) sum += column_sums_[at(x)];
  for (int x = winners.first; x < winners.end; ++x) {
    sum += column_sums_[at(x + r)];
    if (sum < options.texture_threshold) out[x] = kInvalidDisparity;
    sum -= column_sums_[at(x - r)];
  }
}

std::size_t TextureCheck::scratch_bytes() const noexcept { return column_sums_.size() * sizeof(column_sums_[0]); }

}  // namespace stereod
