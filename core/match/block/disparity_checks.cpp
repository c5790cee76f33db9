// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/block/disparity_checks.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "core/match/block/interpolation.h"

namespace stereod {
namespace {

std::size_t as_index(int x) { return static_cast<std::size_t>(x); }

std::int16_t minimum_of(const std::int16_t* values, int count) {
  std::int16_t minimum = values[0];
  for (int i = 1; i < count; ++i) minimum = std::min(minimum, values[i]);
  return minimum;
}

struct Baseline {};

template <typename Real>
void write_subpixel(const RowWinners& winners, const MatcherOptions& options, std::int16_t* out) {
  const std::size_t first = as_index(winners.first);
  interpolate<Real, Baseline>(winners.index.data() + first, winners.cost.data() + first,
                              winners.before.data() + first, winners.after.data() + first,
                              winners.end - winners.first, options.min_disparity, options.disparities,
                              out + first);
}

}  // namespace

void write_disparities(const RowWinners& winners, const MatcherOptions& options, std::int16_t* out) noexcept {
  if (!options.subpixel) {
    for (int x = winners.first; x < winners.end; ++x) {
      out[x] = static_cast<std::int16_t>(options.min_disparity + winners.index[as_index(x)]);
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
    // No branch: kInvalidDisparity has all bits set.
    static_assert(kInvalidDisparity == -1);
    out[x] = static_cast<std::int16_t>(out[x] | -ambiguous[x]);
  }
}

void reject_left(const RowWinners& winners, const std::uint8_t* valid, std::int16_t* out) noexcept {
  for (int x = winners.first; x < winners.end; ++x) {
    out[x] = static_cast<std::int16_t>(out[x] | (valid[x] - 1));  // 1 keeps the disparity, 0 sets all bits
  }
}

void reject_right(const RowWinners& winners, int min_disparity, const std::uint8_t* valid,
                  std::int16_t* out) noexcept {
  for (int x = winners.first; x < winners.end; ++x) {
    const int match = x - min_disparity - winners.index[as_index(x)];
    out[x] = static_cast<std::int16_t>(out[x] | (valid[match] - 1));
  }
}

LeftRightCheck::LeftRightCheck(int width)
    : matches_(as_index(width + kUnroll)),
      best_(as_index(width + kMaxIndices)),
      best_k_(as_index(width + kUnroll)) {}

void LeftRightCheck::reject(const RowWinners& winners, const MatcherOptions& options,
                            std::int16_t* out) noexcept {
  if (options.cost == Cost::kSad) {  // costs stay below 2^18, k below 2^8
    reject_inconsistent(reinterpret_cast<std::uint32_t*>(matches_.data()),
                        reinterpret_cast<std::uint32_t*>(best_.data()), winners, options, out);
  } else {
    reject_inconsistent(matches_.data(), best_.data(), winners, options, out);
  }
}

// A score is the cost and k of a match in one number. Among the left pixels that match the same right one,
// the lowest x has the lowest k, so the minimum score is the best match. The best scores lie from right to
// left, so that k is added to the position of a column. The two loops that vectors cannot do are unrolled, do
// nothing else, and end with scores that change nothing.
template <typename Score>
void LeftRightCheck::reject_inconsistent(Score* matches, Score* best, const RowWinners& winners,
                                         const MatcherOptions& options, std::int16_t* out) {
  constexpr Score kNone = std::numeric_limits<Score>::max();
  const std::uint16_t* index = winners.index.data() + winners.first;
  const std::uint32_t* cost = winners.cost.data() + winners.first;
  const std::ptrdiff_t count = winners.end - winners.first;
  std::fill_n(best, count + kMaxIndices, kNone);
  for (std::ptrdiff_t i = 0; i < count; ++i) matches[i] = Score{cost[i]} * kMaxIndices | index[i];
  std::fill_n(matches + count, kUnroll, kNone);

  const auto index_of = [](Score score) { return static_cast<std::ptrdiff_t>(score % kMaxIndices); };
  for (std::ptrdiff_t i = 0, position = count - 1; i < count; i += kUnroll, position -= kUnroll) {
#pragma GCC unroll 8
    for (std::ptrdiff_t j = 0; j < kUnroll; ++j) {
      const Score match = matches[i + j];
      Score& other = best[position - j + index_of(match)];
      other = match < other ? match : other;
    }
  }
  std::uint16_t* best_k = best_k_.data();
  for (std::ptrdiff_t i = 0, position = count - 1; i < count; i += kUnroll, position -= kUnroll) {
#pragma GCC unroll 8
    for (std::ptrdiff_t j = 0; j < kUnroll; ++j) {
      const Score match = best[position - j + index_of(matches[i + j])];
      best_k[i + j] = static_cast<std::uint16_t>(index_of(match));
    }
  }

  const auto max_diff = static_cast<std::int16_t>(options.left_right_max_diff);
  std::int16_t* result = out + winners.first;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const auto difference = static_cast<std::int16_t>(std::abs(best_k[i] - index[i]));
    result[i] = static_cast<std::int16_t>(result[i] | -static_cast<int>(difference > max_diff));
  }
}

std::size_t LeftRightCheck::scratch_bytes() const noexcept {
  return (matches_.size() + best_.size()) * sizeof(matches_[0]) + best_k_.size() * sizeof(best_k_[0]);
}

TextureCheck::TextureCheck(int width) : width_(width), column_sums_(as_index(width + kBlock)) {}

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

// A block of windows passes as a whole if each of its columns has enough gradient, which is the usual case.
// Else each window is summed from its columns, eight windows a vector, which is faster than one sliding sum.
void TextureCheck::reject(const RowWinners& winners, const MatcherOptions& options,
                          std::int16_t* out) noexcept {
  const int threshold = options.texture_threshold;
  const int enough = (threshold + options.window - 1) / options.window;  // for each column
  for (int x = winners.first; x < winners.end; x += kBlock) {
    const int count = std::min(kBlock, winners.end - x);
    const std::int16_t* columns = column_sums_.data() + x - options.window / 2;
    if (minimum_of(columns, count + options.window - 1) < enough) {
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
  const auto limit = static_cast<std::uint16_t>(std::min(threshold, 0xFFFF));  // sums are below 0xFFFF
  for (int j = 0; j < count; ++j) {
    out[j] = static_cast<std::int16_t>(out[j] | -static_cast<int>(sums[j] < limit));
  }
}

std::size_t TextureCheck::scratch_bytes() const noexcept {
  return column_sums_.size() * sizeof(column_sums_[0]);
}

}  // namespace stereod
