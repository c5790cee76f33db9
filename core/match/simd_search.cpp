// Drives the vector kernels: which arithmetic fits, how the disparities are cut into chunks, whose memory is
// used.
#include "core/match/isa.h"
#include "core/match/kernels/kernel.h"
#include "core/match/row_filters.h"
#include "core/match/row_search.h"

namespace stereod {
namespace {

using kernels::Arithmetic;
using kernels::Kernel;
using kernels::Shape;

const Kernel& kernel_for(Isa isa) {
  switch (isa) {
#if defined(__x86_64__) || defined(__i386__)
    case Isa::kSsse3:
      return kernels::kSsse3Kernel;
    case Isa::kSse41:
      return kernels::kSse41Kernel;
    case Isa::kAvx2:
      return kernels::kAvx2Kernel;
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
  return largest * 8 + 7 < kMasked ? Arithmetic::kPacked : Arithmetic::kNarrow;
}

int rounded_up(int value, int multiple) { return (value + multiple - 1) / multiple * multiple; }

Shape shape_for(const MatcherOptions& options, int width, const Kernel& kernel) {
  Shape shape{};
  shape.arithmetic = fitting_arithmetic(options);
  shape.width = width;
  shape.min_disparity = options.min_disparity;
  shape.disparities = options.disparities;
  shape.window = options.window;
  if (shape.arithmetic == Arithmetic::kWide) {
    shape.chunks = 1;
  } else {
    shape.chunks = (options.disparities + kernels::kMaxChunk - 1) / kernels::kMaxChunk;
  }
  shape.chunk = rounded_up((options.disparities + shape.chunks - 1) / shape.chunks, kernel.granularity);
  shape.neighbours = options.subpixel;
  shape.rival = options.uniqueness_ratio > 0;
  return shape;
}

std::size_t size(int value) { return static_cast<std::size_t>(value); }

class SimdSearch final : public RowSearch {
 public:
  SimdSearch(const MatcherOptions& options, int width)
      : options_(options),
        kernel_(kernel_for(resolve_isa(options.isa))),
        shape_(shape_for(options, width, kernel_)),
        right_row_(size(shape_.right_row_bytes())),
        differences_(size(shape_.window) * difference_row_bytes()),
        column_sums_(size(shape_.chunks) * size(shape_.window + shape_.columns()) * size(shape_.chunk)),
        block_sums_(size(kernels::kBlockColumns) * size(shape_.padded_disparities()) + 2 * kBlockMargin) {}

  void reset() noexcept override {
    column_sums_.fill_zero();
    differences_.fill_zero();
    oldest_ = 0;
  }

  void add_row(const std::uint8_t* left, const std::uint8_t* right, RowWinners* winners) noexcept override {
    kernel_.prepare_right_row(shape_, right, right_row_.data());
    const kernels::AddedRow row{left + shape_.min_disparity, right_row_.data(),
                                differences_.data() + size(oldest_) * difference_row_bytes()};
    const kernels::Scratch scratch{column_sums_.data(), block_sums_.data() + kBlockMargin};
    oldest_ = (oldest_ + 1) % shape_.window;
    if (winners == nullptr) return kernel_.add_row(shape_, row, scratch);
    const auto at = size(winners->first);
    kernel_.search_row(shape_, row, scratch,
                       {winners->index.data() + at, winners->cost.data() + at, winners->before.data() + at,
                        winners->after.data() + at, winners->rival.data() + at});
  }

  void write(const RowWinners& winners, std::int16_t* out) const noexcept override {
    if (!options_.subpixel) return write_disparities(winners, options_, out);
    const auto at = size(winners.first);
    kernel_.interpolate(winners.index.data() + at, winners.cost.data() + at, winners.before.data() + at,
                        winners.after.data() + at, winners.end - winners.first, options_.min_disparity,
                        options_.disparities, out + at);
  }

  std::size_t scratch_bytes() const noexcept override {
    return right_row_.size() + differences_.size() + 2 * (column_sums_.size() + block_sums_.size());
  }

 private:
  static constexpr std::size_t kBlockMargin =
      64;  // the neighbours of the first and last disparity may be read

  std::size_t difference_row_bytes() const { return static_cast<std::size_t>(shape_.difference_row_bytes()); }

  MatcherOptions options_;
  const Kernel& kernel_;
  Shape shape_;
  AlignedBuffer<std::uint8_t> right_row_;    // as the kernel wants it
  AlignedBuffer<std::uint8_t> differences_;  // of the last `window` rows, in turn
  AlignedBuffer<std::uint16_t> column_sums_;
  AlignedBuffer<std::uint16_t> block_sums_;
  int oldest_ = 0;  // which row of differences leaves next
};

}  // namespace

std::unique_ptr<RowSearch> make_simd_search(const MatcherOptions& options, int width) {
  return std::make_unique<SimdSearch>(options, width);
}

}  // namespace stereod
