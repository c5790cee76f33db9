// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/semiglobal/pixel_costs.h"

#include <algorithm>
#include <bit>

namespace stereod::semiglobal {
namespace {

std::size_t as_size(int value) { return static_cast<std::size_t>(value); }

constexpr int kNibbles = 16;
constexpr int kNibbleShift = 4;  // a left nibble is the offset of its table of 16 bytes

// The planes hold these beyond the image. No census comparison differs, because the tables give 0 for 128.
// The gradient differs by at least 64, the maximum of gradient_limit, also modulo 256: gradients are at most
// 126.
constexpr std::uint8_t kOutside[kPlanes] = {128, 128, 191};

}  // namespace

PixelCosts::PixelCosts(const MatcherOptions& options, const SearchParams& params, const Kernel& kernel)
    : params_(params),
      kernel_(kernel),
      prefilter_cap_(options.prefilter_cap),
      tables_(as_size(kNibbles * kNibbles)),
      offsets_(as_size((params.width + kColumnPadding) * params.vectors)),
      left_(as_size(kPlanes * params.row_bytes())),
      right_(as_size(kPlanes * params.row_bytes())),
      scratch_(as_size(2 * params.row_bytes())),
      stripes_(as_size(kPlanes * params.vectors * params.stripe_bytes())) {
  for (unsigned left = 0; left < kNibbles; ++left) {
    for (unsigned right = 0; right < kNibbles; ++right) {
      tables_[left * kNibbles + right] =
          static_cast<std::uint8_t>(options.census_weight * std::popcount(left ^ right));
    }
  }
  for (int x = 0; x < params.width + kColumnPadding; ++x) {
    const int match =
        std::max(std::min(x, params.width - 1) - params.min_disparity, -1);  // -1: outside the image
    for (int k = 0; k < params.vectors; ++k) {
      const int reversed = params.row_bytes() - 1 - match + k;
      offsets_[as_size(x * params.vectors + k)] =
          reversed % params.vectors * params.stripe_bytes() + reversed / params.vectors;
    }
  }
  const std::size_t plane = stripes_.size() / kPlanes;
  for (std::size_t i = 0; i < kPlanes; ++i) std::fill_n(stripes_.data() + i * plane, plane, kOutside[i]);
}

void PixelCosts::write(const PixelRows& left, const PixelRows& right, std::uint8_t* costs) noexcept {
  describe(left, kNibbleShift, left_.data());
  for (int i = 0; i < kPlanes; ++i) {
    std::uint8_t* const end = left_.data() + i * params_.row_bytes() + params_.width;
    std::fill_n(end, kColumnPadding, end[-1]);
  }
  describe(right, 0, right_.data());
  const std::size_t plane = stripes_.size() / kPlanes;
  for (std::size_t i = 0; i < kPlanes; ++i) {
    kernel_.stripe_row(params_, right_.data() + i * as_size(params_.row_bytes()), scratch_.data(),
                       stripes_.data() + i * plane);
  }
  kernel_.cost_row(params_, {left_.data(), stripes_.data(), tables_.data(), offsets_.data(), costs});
}

void PixelCosts::describe(const PixelRows& rows, int shift, std::uint8_t* planes) noexcept {
  kernel_.census_row(rows.census, params_.row_bytes(), shift, planes);
  kernel_.xsobel_row(rows.above, rows.row, rows.below, params_.width, prefilter_cap_,
                     planes + 2 * as_size(params_.row_bytes()));
}

std::size_t PixelCosts::scratch_bytes() const noexcept {
  return tables_.size() + offsets_.size() * sizeof(offsets_[0]) + left_.size() + right_.size() +
         scratch_.size() + stripes_.size();
}

}  // namespace stereod::semiglobal
