// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/matcher_cases.h"

#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "core/match/band_matcher.h"
#include "core/match/frame_matcher.h"

namespace stereod {
namespace {

constexpr std::int16_t kGuard = 0x5a5a;
constexpr int kGuardWidth = 3;

/// A copy of an image without padding, one byte off alignment.
class TightImage {
 public:
  explicit TightImage(const GrayImage& image)
      : size_(image.size()),
        bytes_(1 + static_cast<std::size_t>(size_.width) * static_cast<std::size_t>(size_.height)) {
    copy_pixels(image.view(), {bytes_.data() + 1, size_.width, size_.height, size_.width});
  }
  GrayView view() const { return {bytes_.data() + 1, size_.width, size_.height, size_.width}; }

 private:
  Size size_;
  std::vector<std::uint8_t> bytes_;
};

/// Memory for disparities, with guard values before, between and after the rows.
class GuardedDisparities {
 public:
  explicit GuardedDisparities(Size size)
      : size_(size),
        stride_(static_cast<std::size_t>(size.width + kGuardWidth)),
        values_(kGuardWidth + stride_ * static_cast<std::size_t>(size.height), kGuard) {}

  ImageView<std::int16_t> view() {
    return {values_.data() + kGuardWidth, size_.width, size_.height,
            static_cast<std::ptrdiff_t>(stride_ * sizeof(std::int16_t))};
  }
  bool guards_are_whole() const {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      if (i % stride_ < kGuardWidth && values_[i] != kGuard) return false;
    }
    return true;
  }

 private:
  Size size_;
  std::size_t stride_;
  std::vector<std::int16_t> values_;
};

}  // namespace

const std::vector<Isa>& isas_that_run() {
  static const std::vector<Isa> found = [] {
    std::vector<Isa> isas;
    for (const Isa isa : {Isa::kAuto, Isa::kScalar, Isa::kSsse3, Isa::kSse41, Isa::kAvx2, Isa::kNeon}) {
      MatcherOptions options;
      options.isa = isa;
      try {
        make_band_matcher(options, {64, 48});
        isas.push_back(isa);
      } catch (const std::invalid_argument&) {
        continue;  // missing in this CPU or this build
      }
    }
    return isas;
  }();
  return found;
}

std::vector<MatcherOptions> implementations_of(const MatcherOptions& options) {
  std::vector<MatcherOptions> all;
  const auto add = [&](Implementation implementation, Isa isa) {
    all.push_back(options);
    all.back().implementation = implementation;
    all.back().isa = isa;
  };
  add(Implementation::kNaive, Isa::kAuto);
  if (options.cost != Cost::kSad) return all;  // the others support only kSad
  if (options.method == Method::kSemiglobal) {
    for (const Isa isa : isas_that_run()) add(Implementation::kSimd, isa);
    return all;
  }
  add(Implementation::kSliding, Isa::kAuto);
  for (const Isa isa : isas_that_run()) {
    for (const CacheUse cache : {CacheUse::kLarge, CacheUse::kSmall}) {
      add(Implementation::kSimd, isa);
      all.back().cache = cache;
    }
  }
  return all;
}

std::string describe(const MatcherOptions& o) {
  std::ostringstream text;
  text << name_of(o.method) << " " << name_of(o.implementation) << "/" << name_of(o.isa) << "/"
       << name_of(o.cache) << " cost=" << name_of(o.cost) << " min_disparity=" << o.min_disparity
       << " disparities=" << o.disparities << " window=" << o.window << " prefilter=" << name_of(o.prefilter)
       << " prefilter_cap=" << o.prefilter_cap << " subpixel=" << o.subpixel
       << " texture_threshold=" << o.texture_threshold << " uniqueness_ratio=" << o.uniqueness_ratio
       << " left_right_max_diff=" << o.left_right_max_diff << " median=" << o.median
       << " grid=" << name_of(o.grid) << " p1=" << o.p1 << " p2=" << o.p2
       << " census_weight=" << o.census_weight << " gradient_limit=" << o.gradient_limit
       << " fill=" << o.hole_filling << " speckle_size=" << o.speckle_size
       << " speckle_max_diff=" << o.speckle_max_diff;
  return text.str();
}

WorkerPool& pool_of(int workers) {
  static std::map<int, std::unique_ptr<WorkerPool>> pools;
  std::unique_ptr<WorkerPool>& pool = pools[workers];
  if (!pool) pool = std::make_unique<WorkerPool>(workers);
  return *pool;
}

testing::AssertionResult same_disparities(const DisparityImage& oracle, DisparityView matched) {
  if (oracle.size() != matched.size()) return testing::AssertionFailure() << "the sizes differ";
  int differing = 0;
  int first_x = 0;
  int first_y = 0;
  for (int y = 0; y < oracle.height(); ++y) {
    for (int x = 0; x < oracle.width(); ++x) {
      if (oracle.at(x, y) == matched.at(x, y)) continue;
      if (differing++ > 0) continue;
      first_x = x;
      first_y = y;
    }
  }
  if (differing == 0) return testing::AssertionSuccess();
  return testing::AssertionFailure() << differing << " of " << oracle.width() << "x" << oracle.height()
                                     << " pixels differ, first (" << first_x << ", " << first_y
                                     << "): oracle " << oracle.at(first_x, first_y) << ", matcher "
                                     << matched.at(first_x, first_y);
}

testing::AssertionResult agrees(const DisparityImage& oracle, const StereoPair& pair,
                                const StereoPair& before, const MatcherOptions& options, int workers) {
  const TightImage left(pair.left);
  const TightImage right(pair.right);
  GuardedDisparities disparities(oracle.size());
  FrameMatcher matcher(options, oracle.size(), pool_of(workers));
  if (!before.left.empty()) matcher.match(before.left.view(), before.right.view(), disparities.view());
  matcher.match(left.view(), right.view(), disparities.view());
  if (!disparities.guards_are_whole()) {
    return testing::AssertionFailure()
           << "wrote outside the disparity image: " << describe(options) << ", " << workers << " workers";
  }
  testing::AssertionResult result = same_disparities(oracle, disparities.view());
  if (!result) result << "\n  " << describe(options) << ", " << workers << " workers";
  return result;
}

}  // namespace stereod
