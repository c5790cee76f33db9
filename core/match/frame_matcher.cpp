// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/frame_matcher.h"

#include <algorithm>
#include <cassert>

namespace stereod {

FrameMatcher::FrameMatcher(const MatcherOptions& options, Size image, WorkerPool& pool)
    : options_(options), image_(image), pool_(pool) {
  for (int worker = 0; worker < pool.workers(); ++worker)
    matchers_.push_back(make_band_matcher(options, image));
  if (options.speckle_size > 0) speckle_filter_.emplace(image);
}

void FrameMatcher::use_masks(const ValidityMask* left, const ValidityMask* right) noexcept {
  for (const auto& matcher : matchers_) matcher->use_masks(left, right);
}

void FrameMatcher::match(GrayView left, GrayView right, ImageView<std::int16_t> out) {
  assert(left.size() == image_ && right.size() == image_ && out.size() == image_);
  const int bands = std::min(pool_.workers(), image_.height);
  pool_.run(bands, [&](int band, int worker) {
    match_band(*matchers_[static_cast<std::size_t>(worker)], left, right,
               band_rows(image_.height, band, bands), out);
  });
  if (speckle_filter_) {
    speckle_filter_->apply(out, options_.speckle_size,
                           options_.speckle_max_diff * options_.units_per_pixel());
  }
}

void FrameMatcher::match_band(BandMatcher& matcher, GrayView left, GrayView right, RowRange rows,
                              ImageView<std::int16_t> out) {
  const RowRange input = matcher.begin(rows);
  for (int y = input.first; y < input.end; ++y) {
    std::copy_n(left.row(y), left.width(), matcher.left_row(y));
    std::copy_n(right.row(y), right.width(), matcher.right_row(y));
    const RowRange done = matcher.push(y);
    for (int row = done.first; row < done.end; ++row) {
      std::copy_n(matcher.disparity_row(row), out.width(), out.row(row));
    }
  }
}

}  // namespace stereod
