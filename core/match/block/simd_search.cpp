// Drives the vector kernels: which arithmetic fits, how disparities are cut into chunks and columns into
// strips, whose memory is used.
#include <algorithm>
#include <vector>

#include "core/base/cpu.h"
#include "core/match/block/disparity_checks.h"
#include "core/match/block/kernels/kernel.h"
#include "core/match/block/row_search.h"
#include "core/match/row_ring.h"

namespace stereod {
namespace {

using kernels::Arithmetic;
using kernels::Kernel;
using kernels::Shape;
using kernels::Strip;

const Kernel& kernel_for(Isa isa) {
  switch (isa) {
#if defined(__x86_64__) || defined(__i386__)
    case Isa::kSsse3:
      return kernels::kSsse3Kernel;
    case Isa::kSse41:
      return kernels::kSse41Kernel;
    case Isa::kAvx2:
      return kernels::kAvx2Kernel;
#elif defined(__aarch64__) || defined(__ARM_NEON)
    case Isa::kNeon:
      return kernels::kNeonKernel;
#endif
    default:
      return kernels::kScalarKernel;
  }
}

Arithmetic fitting_arithmetic(const MatcherOptions& options) {
  const bool small_differences = options.prefilter == Prefilter::kXsobel;
  const int largest = (small_differences ? 2 * options.prefilter_cap : 255) * options.window * options.window;
  constexpr int kMasked = 0xFFFF;  // what disparities that cannot be searched count as; no cost may reach it
  if (largest >= kMasked) return Arithmetic::kWide;
  if (!small_differences) return Arithmetic::kRaw;
  if (largest * 8 + 7 < kMasked) return Arithmetic::kPacked;
  return largest * 4 + 3 < kMasked ? Arithmetic::kPackedHalves : Arithmetic::kRaw;
}

Shape shape_for(const MatcherOptions& options, int width, const Kernel& kernel) {
  Shape shape{};
  shape.arithmetic = fitting_arithmetic(options);
  shape.width = width;
  shape.min_disparity = options.min_disparity;
  shape.disparities = options.disparities;
  shape.window = options.window;
  if (shape.arithmetic == Arithmetic::kWide) {
    shape.chunks = 1;
    shape.chunk = (options.disparities + kernels::kMaxVector - 1) / kernels::kMaxVector * kernels::kMaxVector;
  } else {
    shape.chunks = (options.disparities + kernels::kMaxChunk - 1) / kernels::kMaxChunk;
    shape.chunk = kernel.chunk_for((options.disparities + shape.chunks - 1) / shape.chunks);
  }
  shape.recompute = resolve_cache_use(options.cache) == CacheUse::kSmall;
  shape.neighbors = options.subpixel;
  shape.uniqueness_ratio = options.uniqueness_ratio;
  return shape;
}

// Strips overlap by a window less one column, and have answers for whole blocks. In a cache of 24 KiB, 20 KiB
// of column sums leave room for the rows compared; one block is what a strip has at least, or it would mostly
// overlap.
std::vector<Strip> strips_for(const Shape& shape) {
  const int overlap = shape.window - 1;
  int answers = shape.columns() - overlap;
  if (shape.recompute) {
    constexpr int kSumBytes = 20 * 1024;
    const int columns = kSumBytes / (2 * shape.padded_disparities()) - overlap;
    answers = std::max(1, columns / kernels::kBlockColumns) * kernels::kBlockColumns;
  }
  std::vector<Strip> strips;
  for (int first = 0; first < shape.columns() - overlap; first += answers) {
    strips.push_back({first, std::min(first + answers + overlap, shape.columns())});
  }
  return strips;
}

std::size_t size(int value) { return static_cast<std::size_t>(value); }

class SimdSearch final : public RowSearch {
  static_assert(kernels::kBlockColumns <= RowWinners::kMargin);

 public:
  SimdSearch(const MatcherOptions& options, int width)
      : options_(options),
        kernel_(kernel_for(resolve_isa(options.isa))),
        shape_(shape_for(options, width, kernel_)),
        strips_(strips_for(shape_)),
        right_rows_(shape_.right_row_bytes(), shape_.recompute ? shape_.window + kBatch : 1),
        left_rows_(size(shape_.recompute ? shape_.window + kBatch : 1)),
        zeros_(shape_.recompute ? size(shape_.right_row_bytes()) : difference_row_bytes()),
        differences_(shape_.recompute ? 0 : size(shape_.window + 1) * difference_row_bytes()),
        block_sums_(size(kernels::kBlockColumns) * size(shape_.block_step()) + 2 * kBlockMargin) {
    std::fill_n(block_sums_.data(), block_sums_.size(), kernel_.no_sum);
    for (const Strip& strip : strips_) {
      column_sums_.emplace_back(size(shape_.window + strip.columns()) * size(shape_.padded_disparities()));
    }
  }

  void reset() noexcept override {
    for (auto& sums : column_sums_) sums.fill_zero();
    next_row_ = 0;
  }

  int batch() const noexcept override { return shape_.recompute ? kBatch : 1; }

  void add_rows(std::span<const SearchRow> rows) noexcept override {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const int y = next_row_ + static_cast<int>(i);
      left_rows_[size(y) % left_rows_.size()] = rows[i].left + shape_.min_disparity;
      kernel_.prepare_right_row(shape_, rows[i].right, right_rows_.row(y));
    }
    for (std::size_t s = 0; s < strips_.size(); ++s) {  // from left to right, as Winners wants it
      for (std::size_t i = 0; i < rows.size(); ++i)
        add_row(s, next_row_ + static_cast<int>(i), rows[i].winners);
    }
    next_row_ += static_cast<int>(rows.size());
  }

  void write(const RowWinners& winners, std::int16_t* out) const noexcept override {
    if (!options_.subpixel) return write_disparities(winners, options_, out);
    const auto at = size(winners.first);
    kernel_.interpolate(winners.index.data() + at, winners.cost.data() + at, winners.before.data() + at,
                        winners.after.data() + at, winners.end - winners.first, options_.min_disparity,
                        options_.disparities, out + at);
  }

  void prefilter_row(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int width,
                     int cap, std::uint8_t* out) const noexcept override {
    kernel_.xsobel_row(above, row, below, width, cap, out);
  }

  std::size_t scratch_bytes() const noexcept override {
    std::size_t bytes = right_rows_.bytes() + left_rows_.size() * sizeof(left_rows_[0]) + zeros_.size() +
                        differences_.size() + 2 * block_sums_.size();
    for (const auto& sums : column_sums_) bytes += 2 * sums.size();
    return bytes;
  }

 private:
  static constexpr int kBatch = 16;  // rows that pass through a strip while its sums are in the cache
  static constexpr std::size_t kBlockMargin =
      64;  // the neighbors of the first and last disparity may be read

  std::size_t difference_row_bytes() const {
    return size(shape_.columns()) * size(shape_.padded_disparities());
  }

  std::uint8_t* differences(int y) {
    return differences_.data() + size(y % (shape_.window + 1)) * difference_row_bytes();
  }

  kernels::InputRow input_row(int y) const {
    return {left_rows_[size(y) % left_rows_.size()], right_rows_.row(y)};
  }

  void add_row(std::size_t strip, int y, RowWinners* winners) noexcept {
    kernels::RowChange change{input_row(y), {}, nullptr, nullptr};
    const int leaving = y - shape_.window;
    if (shape_.recompute) {
      change.removed = leaving >= 0 ? input_row(leaving) : kernels::InputRow{zeros_.data(), zeros_.data()};
    } else {
      change.differences = differences(y);
      change.removed_differences = leaving >= 0 ? differences(leaving) : zeros_.data();
    }
    const kernels::Scratch scratch{column_sums_[strip].data(), block_sums_.data() + kBlockMargin};
    if (winners == nullptr) return kernel_.add_row(shape_, strips_[strip], change, scratch);
    const auto at = size(winners->first);
    kernel_.search_row(shape_, strips_[strip], change, scratch,
                       {winners->index.data() + at, winners->cost.data() + at, winners->before.data() + at,
                        winners->after.data() + at, winners->ambiguous.data() + at});
  }

  MatcherOptions options_;
  const Kernel& kernel_;
  Shape shape_;
  std::vector<Strip> strips_;                              // one over all columns, unless shape_.recompute
  RowRing<std::uint8_t> right_rows_;                       // as the kernel wants them
  std::vector<const std::uint8_t*> left_rows_;             // row y is at y modulo the size
  AlignedBuffer<std::uint8_t> zeros_;                      // what leaves the window while it fills
  AlignedBuffer<std::uint8_t> differences_;                // of the last `window` rows, in turn
  std::vector<AlignedBuffer<std::uint16_t>> column_sums_;  // of each strip
  AlignedBuffer<std::uint16_t> block_sums_;
  int next_row_ = 0;
};

}  // namespace

std::unique_ptr<RowSearch> make_simd_search(const MatcherOptions& options, int width) {
  return std::make_unique<SimdSearch>(options, width);
}

}  // namespace stereod
