// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/matcher_input.h"

#include <algorithm>
#include <sstream>

#include "core/base/cpu.h"
#include "core/match/band_matcher.h"
#include "core/match/frame_matcher.h"
#include "tests/support/matcher_cases.h"

namespace stereod {
namespace {

constexpr int kMaxColumns = 96;
constexpr int kMaxRows = 40;
constexpr double kMaxWork = 8e6;  // differences of the naive implementation: a few milliseconds

/// Takes numbers from the front of the bytes; zeros past the end.
class Bytes {
 public:
  explicit Bytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  int byte() { return at_ < bytes_.size() ? bytes_[at_++] : 0; }
  /// Returns a number in [@p minimum, @p maximum].
  int between(int minimum, int maximum) {
    const int high = byte();
    return minimum + (high * 256 + byte()) % (maximum - minimum + 1);
  }
  /// Returns 0 in half of the cases, else a number in [1, @p maximum].
  int off_or_up_to(int maximum) { return byte() % 2 == 0 ? 0 : between(1, maximum); }
  std::span<const std::uint8_t> rest() const { return bytes_.subspan(at_); }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

void make_semiglobal(Bytes& bytes, MatcherOptions& o) {
  o.method = Method::kSemiglobal;
  o.prefilter = Prefilter::kXsobel;
  o.texture_threshold = 0;
  o.median = o.median == 0 ? 0 : 3;
  o.grid = bytes.byte() % 2 == 0 ? Grid::kCoarse : Grid::kFine;
  o.p1 = bytes.byte();
  o.p2 = bytes.byte();
  o.census_weight = bytes.byte() % 17;
  o.gradient_limit = bytes.byte() % 65;
  o.hole_filling = bytes.byte() % 2 != 0;
}

MatcherOptions options_of(Bytes& bytes) {
  MatcherOptions o;
  o.min_disparity = bytes.byte() % 8 == 7 ? bytes.between(0, 1024) : bytes.byte() % 24;
  o.disparities = bytes.byte() + 1;
  o.window = 3 + 2 * (bytes.byte() % 15);
  o.prefilter = bytes.byte() % 3 == 0 ? Prefilter::kNone : Prefilter::kXsobel;
  o.prefilter_cap = bytes.between(1, 63);
  const int texture = bytes.off_or_up_to(o.prefilter_cap * o.window * o.window);
  if (o.prefilter == Prefilter::kXsobel) o.texture_threshold = texture;
  o.uniqueness_ratio = bytes.off_or_up_to(100);
  o.left_right_max_diff = bytes.off_or_up_to(256) - 1;
  o.subpixel = bytes.byte() % 2 != 0;
  constexpr std::array kMedians = {0, 3, 5};
  o.median = kMedians[static_cast<std::size_t>(bytes.byte()) % kMedians.size()];
  o.speckle_size = bytes.off_or_up_to(400);
  o.speckle_max_diff = bytes.byte() % 4 == 0 ? bytes.byte() : bytes.byte() % 3;
  if (bytes.byte() % 2 != 0) make_semiglobal(bytes, o);
  return o;
}

/// Returns no mask in half of the cases; else one in which single pixels, or all past a column, have no
/// source.
std::optional<ValidityMask> mask_of(Bytes& bytes, Size size) {
  const int kind = bytes.byte() % 4;
  const int number = bytes.byte();
  if (kind < 2) return std::nullopt;
  Random random(static_cast<std::uint64_t>(number));
  return ValidityMask(size, [&](int x, int) {
    return kind == 2 ? !random.one_in(1 + number % 16) : x < number % kMaxColumns;
  });
}

const ValidityMask* pointer_to(const std::optional<ValidityMask>& mask) { return mask ? &*mask : nullptr; }

/// Turns bytes into pixels. Raw bytes alone would rarely look like a surface.
StereoPair pair_of(Bytes& bytes, Size size) {
  const int kind = bytes.byte() % 4;
  const auto content = static_cast<std::size_t>(bytes.byte()) % kAllContents.size();
  const auto seed = static_cast<std::uint64_t>(bytes.between(0, 65'535));
  if (kind == 0) return random_pair(kAllContents[content], size, seed);
  const int shift = bytes.byte() % 32;
  const std::span<const std::uint8_t> pixels = bytes.rest();
  const auto pixel = [&](std::size_t at) -> std::uint8_t {
    return pixels.empty() ? std::uint8_t{0} : pixels[at % pixels.size()];
  };
  StereoPair pair{GrayImage(size), GrayImage(size)};
  std::size_t at = 0;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) pair.right.at(x, y) = pixel(at++);
  }
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      // 1: unrelated images; 2: equal, shifted; 3: shifted and brighter.
      if (kind == 1 || x < shift) {
        pair.left.at(x, y) = pixel(at++);
      } else {
        pair.left.at(x, y) = static_cast<std::uint8_t>(pair.right.at(x - shift, y) + (kind == 3 ? 7 : 0));
      }
    }
  }
  return pair;
}

DisparityImage match_frame(const MatcherInput& input, const MatcherOptions& options, int workers) {
  DisparityImage found(input.pair.left.size());
  FrameMatcher matcher(options, found.size(), pool_of(workers));
  matcher.use_masks(pointer_to(input.left_mask), pointer_to(input.right_mask));
  matcher.match(input.pair.left.view(), input.pair.right.view(), found.view());
  return found;
}

/// Matches all bands with one BandMatcher, so that each finds the memory that the band before left. Bands are
/// matched from the bottom up, an order in which stale memory is never right by chance.
DisparityImage match_bands(const MatcherInput& input, const MatcherOptions& options) {
  const StereoPair& pair = input.pair;
  DisparityImage found(pair.left.size());
  const std::unique_ptr<BandMatcher> matcher = make_band_matcher(options, found.size());
  matcher->use_masks(pointer_to(input.left_mask), pointer_to(input.right_mask));
  std::vector<int> ends = input.cuts;
  ends.push_back(found.height());
  for (std::size_t band = ends.size(); band-- > 0;) {
    const int first = band == 0 ? 0 : ends[band - 1];
    const RowRange rows = matcher->begin({first, ends[band]});
    for (int y = rows.first; y < rows.end; ++y) {
      std::copy_n(pair.left.row(y), pair.left.width(), matcher->left_row(y));
      std::copy_n(pair.right.row(y), pair.right.width(), matcher->right_row(y));
      const RowRange final_rows = matcher->push(y);
      for (int f = final_rows.first; f < final_rows.end; ++f) {
        std::copy_n(matcher->disparity_row(f), found.width(), found.row(f));
      }
    }
  }
  return found;
}

std::vector<MatcherOptions> contestants(const MatcherOptions& options) {
  std::vector<MatcherOptions> all;
  for (const Implementation implementation : {Implementation::kNaive, Implementation::kSliding}) {
    if (implementation == Implementation::kSliding && options.method == Method::kSemiglobal) continue;
    all.push_back(options);
    all.back().implementation = implementation;
  }
  for (const Isa isa : available_isas()) {
    for (const CacheUse cache : {CacheUse::kLarge, CacheUse::kSmall}) {
      all.push_back(options);
      all.back().implementation = Implementation::kSimd;
      all.back().isa = isa;
      all.back().cache = cache;
    }
  }
  return all;
}

std::string complaint(const MatcherInput& input, const MatcherOptions& options, const std::string& way,
                      const testing::AssertionResult& result) {
  std::ostringstream text;
  text << input.pair.left.width() << "x" << input.pair.left.height() << ", " << describe(options)
       << " cache=" << name_of(options.cache) << ", " << way << (input.left_mask ? ", left mask" : "")
       << (input.right_mask ? ", right mask" : "") << ": " << result.message();
  for (const int cut : input.cuts) text << " cut=" << cut;
  return text.str();
}

}  // namespace

std::optional<MatcherInput> matcher_input(std::span<const std::uint8_t> data) {
  Bytes bytes(data);
  const Size size{1 + bytes.byte() % kMaxColumns, 1 + bytes.byte() % kMaxRows};
  MatcherInput input;
  input.options = options_of(bytes);
  const int window = input.options.window;
  const double columns = std::max(0, size.width - window + 1);
  const double rows = std::max(0, size.height - window + 1);
  const double disparities = std::min<double>(input.options.disparities, columns);
  // The approximate work of the semi-global reference for each pixel and disparity.
  constexpr double kSemiglobalWork = 20;
  const double work = input.options.method == Method::kBlock
                          ? columns * rows * disparities * window * window
                          : kSemiglobalWork * size.width * size.height * input.options.disparities;
  if (work > kMaxWork) return std::nullopt;
  for (int row = 0; row < size.height - 1;) {
    row += 1 + bytes.byte() % kMaxRows;
    if (row < size.height) input.cuts.push_back(row);
  }
  input.left_mask = mask_of(bytes, size);
  input.right_mask = mask_of(bytes, size);
  input.pair = pair_of(bytes, size);
  return input;
}

std::optional<std::string> disagreement_on(const MatcherInput& input) {
  MatcherOptions naive = input.options;
  naive.implementation = Implementation::kNaive;
  const DisparityImage reference = match_frame(input, naive, 1);
  for (const MatcherOptions& options : contestants(input.options)) {
    for (int workers = 1; workers <= 3; ++workers) {
      const DisparityImage found = match_frame(input, options, workers);
      const testing::AssertionResult same = same_disparities(reference, found.view());
      if (!same) return complaint(input, options, std::to_string(workers) + " workers", same);
    }
  }
  // Speckle removal needs the whole image, so a band matcher does not do it.
  MatcherOptions banded = input.options;
  banded.speckle_size = 0;
  naive.speckle_size = 0;
  const DisparityImage unfiltered = match_frame(input, naive, 1);
  for (const MatcherOptions& options : contestants(banded)) {
    const DisparityImage found = match_bands(input, options);
    const testing::AssertionResult same = same_disparities(unfiltered, found.view());
    if (!same) return complaint(input, options, "in bands", same);
  }
  return std::nullopt;
}

}  // namespace stereod
