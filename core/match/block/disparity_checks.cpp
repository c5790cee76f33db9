#include "core/match/block/disparity_checks.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "core/match/block/interpolation.h"

namespace stereod {
namespace {

std::size_t at(int x) { return static_cast<std::size_t>(x); }

std::int16_t least_of(const std::int16_t* values, int count) {
  std::int16_t least = values[0];
  for (int i = 1; i < count; ++i) least = std::min(least, values[i]);
  return least;
}

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

LeftRightCheck::LeftRightCheck(int width)
    : claims_(at(width + kUnroll)),
      standing_(at(width + kMaxIndices)),
      standing_index_(at(width + kUnroll)) {}

void LeftRightCheck::reject(const RowWinners& winners, const MatcherOptions& options,
                            std::int16_t* out) noexcept {
  if (options.cost == Cost::kSad) {  // costs stay below 2^18, k below 2^8
    reject_by(reinterpret_cast<std::uint32_t*>(claims_.data()),
              reinterpret_cast<std::uint32_t*>(standing_.data()), winners, options, out);
  } else {
    reject_by(claims_.data(), standing_.data(), winners, options, out);
  }
}

// A claim is cost and k in one number. Of the left pixels that claim the same right one, the lowest x has the
// lowest k, so the least number is the claim that stands. Standing claims lie from right to left, so that k
// is added to a column's place as it is. The two loops that no vector can do are unrolled, do nothing else,
// and end with claims that change nothing.
template <typename Claim>
void LeftRightCheck::reject_by(Claim* claims, Claim* standing, const RowWinners& winners,
                               const MatcherOptions& options, std::int16_t* out) {
  constexpr Claim kNone = std::numeric_limits<Claim>::max();
  const std::uint16_t* index = winners.index.data() + winners.first;
  const std::uint32_t* cost = winners.cost.data() + winners.first;
  const std::ptrdiff_t count = winners.end - winners.first;
  std::fill_n(standing, count + kMaxIndices, kNone);
  for (std::ptrdiff_t i = 0; i < count; ++i) claims[i] = Claim{cost[i]} * kMaxIndices | index[i];
  std::fill_n(claims + count, kUnroll, kNone);

  const auto index_of = [](Claim claim) { return static_cast<std::ptrdiff_t>(claim % kMaxIndices); };
  for (std::ptrdiff_t i = 0, place = count - 1; i < count; i += kUnroll, place -= kUnroll) {
#pragma GCC unroll 8
    for (std::ptrdiff_t j = 0; j < kUnroll; ++j) {
      const Claim claim = claims[i + j];
      Claim& other = standing[place - j + index_of(claim)];
      other = claim < other ? claim : other;
    }
  }
  std::uint16_t* standing_index = standing_index_.data();
  for (std::ptrdiff_t i = 0, place = count - 1; i < count; i += kUnroll, place -= kUnroll) {
#pragma GCC unroll 8
    for (std::ptrdiff_t j = 0; j < kUnroll; ++j) {
      const Claim stands = standing[place - j + index_of(claims[i + j])];
      standing_index[i + j] = static_cast<std::uint16_t>(index_of(stands));
    }
  }

  const auto max_diff = static_cast<std::int16_t>(options.left_right_max_diff);
  std::int16_t* result = out + winners.first;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const auto difference = static_cast<std::int16_t>(std::abs(standing_index[i] - index[i]));
    result[i] = static_cast<std::int16_t>(result[i] | -static_cast<int>(difference > max_diff));
  }
}

std::size_t LeftRightCheck::scratch_bytes() const noexcept {
  return (claims_.size() + standing_.size()) * sizeof(claims_[0]) +
         standing_index_.size() * sizeof(standing_index_[0]);
}

TextureCheck::TextureCheck(int width) : width_(width), column_sums_(at(width + kBlock)) {}

void TextureCheck::reset() noexcept { column_sums_.fill_zero(); }

void TextureCheck::add_row(const std::uint8_t* added, const std::uint8_t* removed, int cap) noexcept {
  std::int16_t* sums = column_sums_.data();
  const auto middle = static_cast<std::int16_t>(cap);
  const auto gradient = [middle](std::uint8_t value) {
    return static_cast<std::int16_t>(std::abs(static_cast<std::int16_t>(value - middle)));
  };
  if (removed == nullptr) {
    for (int x = 0; x < width_; ++x) sums[x] = static_cast<std::int16_t>(sums[x] + gradient(added[x]));
  } else {
    for (int x = 0; x < width_; ++x) {
      sums[x] = static_cast<std::int16_t>(sums[x] + gradient(added[x]) - gradient(removed[x]));
    }
  }
}

// A block of windows passes whole where each of its columns has enough, and mostly they have. Elsewhere each
// window's sum is made anew from its columns, eight windows to a vector: less work than one sum that slides.
void TextureCheck::reject(const RowWinners& winners, const MatcherOptions& options,
                          std::int16_t* out) noexcept {
  const int threshold = options.texture_threshold;
  const int enough = (threshold + options.window - 1) / options.window;  // of each of `window` columns
  for (int x = winners.first; x < winners.end; x += kBlock) {
    const int count = std::min(kBlock, winners.end - x);
    const std::int16_t* columns = column_sums_.data() + x - options.window / 2;
    if (least_of(columns, count + options.window - 1) < enough) {
      reject_block(columns, options.window, threshold, count, out + x);
    }
  }
}

void TextureCheck::reject_block(const std::int16_t* columns, int window, int threshold, int count,
                                std::int16_t* out) {
  std::uint16_t sums[kBlock];
  for (int j = 0; j < kBlock; ++j) sums[j] = static_cast<std::uint16_t>(columns[j]);
  for (int i = 1; i < window; ++i) {
    for (int j = 0; j < kBlock; ++j) sums[j] = static_cast<std::uint16_t>(sums[j] + columns[i + j]);
  }
  const auto least = static_cast<std::uint16_t>(std::min(threshold, 0xFFFF));  // no sum is as large as that
  for (int j = 0; j < count; ++j) {
    out[j] = static_cast<std::int16_t>(out[j] | -static_cast<int>(sums[j] < least));
  }
}

std::size_t TextureCheck::scratch_bytes() const noexcept {
  return column_sums_.size() * sizeof(column_sums_[0]);
}

}  // namespace stereod
