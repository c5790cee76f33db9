// SPDX-License-Identifier: BSD-3-Clause
// The reference behind the interface of bands.
#include <algorithm>

#include "core/match/semiglobal/reference.h"
#include "core/match/semiglobal/semiglobal_matcher.h"

namespace stereod {
namespace {

class ReferenceSemiglobalMatcher final : public BandMatcher {
 public:
  ReferenceSemiglobalMatcher(const MatcherOptions& options, Size image)
      : options_(options), left_(image), right_(image), result_(image) {}

  void use_masks(const ValidityMask* left, const ValidityMask* right) noexcept override {
    left_mask_ = left;
    right_mask_ = right;
  }
  RowRange begin(RowRange rows) noexcept override {
    output_ = rows;
    return {0, left_.height()};
  }
  std::uint8_t* left_row(int y) noexcept override { return left_.row(y); }
  std::uint8_t* right_row(int y) noexcept override { return right_.row(y); }
  RowRange push(int y) noexcept override {
    if (y < left_.height() - 1) return {output_.first, output_.first};
    result_ = semiglobal_reference(left_.view(), right_.view(), options_, left_mask_, right_mask_);
    return output_;
  }
  const std::int16_t* disparity_row(int y) const noexcept override { return result_.row(y); }
  std::size_t scratch_bytes() const noexcept override {
    return static_cast<std::size_t>(2 * left_.view().stride() + result_.view().stride()) *
           static_cast<std::size_t>(left_.height());
  }

 private:
  MatcherOptions options_;
  GrayImage left_, right_;
  DisparityImage result_;
  RowRange output_{};
  const ValidityMask* left_mask_ = nullptr;
  const ValidityMask* right_mask_ = nullptr;
};

}  // namespace

std::unique_ptr<BandMatcher> make_reference_semiglobal_matcher(const MatcherOptions& options, Size image) {
  return std::make_unique<ReferenceSemiglobalMatcher>(options, image);
}

}  // namespace stereod
