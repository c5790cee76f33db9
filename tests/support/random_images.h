// SPDX-License-Identifier: BSD-3-Clause
// Synthetic stereo pairs that are hard to match, equal for equal seeds on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/base/image.h"

namespace stereod {

/// A random number generator (splitmix64, Steele et al. 2014). Unlike the distributions of the standard
/// library it gives the same numbers everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next();
  /// Returns a number in [@p minimum, @p maximum].
  int between(int minimum, int maximum);
  bool one_in(int n) { return between(1, n) == 1; }
  template <typename T, std::size_t N>
  const T& one_of(const std::array<T, N>& choices) {
    return choices[static_cast<std::size_t>(between(0, static_cast<int>(N) - 1))];
  }

 private:
  std::uint64_t state_;
};

enum class Content {
  kNoise,        ///< independent pixels, left and right unrelated
  kSmoothNoise,  ///< blurred noise of low contrast, left and right unrelated: shallow minima
  kSlantedPair,  ///< a textured surface with a disparity that grows along x and y, with a little noise
  kConstant,     ///< one gray value each: only ties
  kTwoLevels,    ///< two gray values a step apart: many ties
  kExtremes,     ///< 0 and 255 in patterns that drive the sums to their maxima
};
inline constexpr std::array kAllContents = {Content::kNoise,    Content::kSmoothNoise, Content::kSlantedPair,
                                            Content::kConstant, Content::kTwoLevels,   Content::kExtremes};

std::string_view name_of(Content content);

struct StereoPair {
  GrayImage left;
  GrayImage right;
};

/// Returns a pair of @p size [≥ 1×1 px].
StereoPair random_pair(Content content, Size size, std::uint64_t seed);

}  // namespace stereod
