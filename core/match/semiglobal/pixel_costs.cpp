#include "core/match/semiglobal/pixel_costs.h"

#include <algorithm>
#include <bit>

namespace stereod::semiglobal {
namespace {

std::size_t size(int value) { return static_cast<std::size_t>(value); }

constexpr int kNibbles = 16;
constexpr int kNibbleShift = 4;  // of left nibbles, which are places of tables of 16 bytes

// What stands in the planes beyond the image: no comparison differs (tables give 0 for it), and the
// gradient differs by at least as much as the greatest limit, 64, also where bytes go round: gradients are at
// most 126.
constexpr std::uint8_t kOutside[kPlanes] = {128, 128, 191};

}  // namespace

PixelCosts::PixelCosts(const MatcherOptions& options, const Shape& shape, const Kernel& kernel)
    : shape_(shape),
      kernel_(kernel),
      prefilter_cap_(options.prefilter_cap),
      tables_(size(kNibbles * kNibbles)),
      offsets_(size((shape.width + kBeyond) * shape.vectors)),
      left_(size(kPlanes * shape.row_bytes())),
      right_(size(kPlanes * shape.row_bytes())),
      scratch_(size(2 * shape.row_bytes())),
      stripes_(size(kPlanes * shape.vectors * shape.stripe_bytes())) {
  for (unsigned left = 0; left < kNibbles; ++left) {
    for (unsigned right = 0; right < kNibbles; ++right) {
      tables_[left * kNibbles + right] =
          static_cast<std::uint8_t>(options.census_weight * std::popcount(left ^ right));
    }
  }
  for (int x = 0; x < shape.width + kBeyond; ++x) {
    const int match = std::max(std::min(x, shape.width - 1) - shape.min_disparity, -1);  // -1: outside
    for (int k = 0; k < shape.vectors; ++k) {
      const int backwards = shape.row_bytes() - 1 - match + k;
      offsets_[size(x * shape.vectors + k)] =
          backwards % shape.vectors * shape.stripe_bytes() + backwards / shape.vectors;
    }
  }
  const std::size_t plane = stripes_.size() / kPlanes;
  for (std::size_t i = 0; i < kPlanes; ++i) std::fill_n(stripes_.data() + i * plane, plane, kOutside[i]);
}

void PixelCosts::write(const PixelRows& left, const PixelRows& right, std::uint8_t* costs) noexcept {
  describe(left, kNibbleShift, left_.data());
  for (int i = 0; i < kPlanes; ++i) {
    std::uint8_t* const end = left_.data() + i * shape_.row_bytes() + shape_.width;
    std::fill_n(end, kBeyond, end[-1]);
  }
  describe(right, 0, right_.data());
  const std::size_t plane = stripes_.size() / kPlanes;
  for (std::size_t i = 0; i < kPlanes; ++i) {
    kernel_.stripe_row(shape_, right_.data() + i * size(shape_.row_bytes()), scratch_.data(),
                       stripes_.data() + i * plane);
  }
  kernel_.cost_row(shape_, {left_.data(), stripes_.data(), tables_.data(), offsets_.data(), costs});
}

void PixelCosts::describe(const PixelRows& rows, int shift, std::uint8_t* planes) noexcept {
  kernel_.census_row(rows.census, shape_.row_bytes(), shift, planes);
  kernel_.xsobel_row(rows.above, rows.row, rows.below, shape_.width, prefilter_cap_,
                     planes + 2 * size(shape_.row_bytes()));
}

std::size_t PixelCosts::scratch_bytes() const noexcept {
  return tables_.size() + offsets_.size() * sizeof(offsets_[0]) + left_.size() + right_.size() +
         scratch_.size() + stripes_.size();
}

}  // namespace stereod::semiglobal
