// SPDX-License-Identifier: BSD-3-Clause
// Drives the vector kernels: chooses the arithmetic, cuts disparities into chunks and columns into tiles, and
// owns the memory.
#include <algorithm>
#include <vector>

#include "core/base/cpu.h"
#include "core/match/block/disparity_checks.h"
#include "core/match/block/kernels/kernel.h"
#include "core/match/block/row_search.h"
#include "core/match/row_stage.h"

namespace stereod {
namespace {

using kernels::Arithmetic;
using kernels::ColumnTile;
using kernels::Kernel;
using kernels::SearchParams;

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
  const int max_cost =
      (small_differences ? 2 * options.prefilter_cap : 255) * options.window * options.window;
  constexpr int kMasked = 0xFFFF;  // the sum of a disparity that cannot be searched; costs must stay below it
  if (max_cost >= kMasked) return Arithmetic::kWide;
  if (!small_differences) return Arithmetic::kRaw;
  if (max_cost * 8 + 7 < kMasked) return Arithmetic::kPacked;
  return max_cost * 4 + 3 < kMasked ? Arithmetic::kPackedHalves : Arithmetic::kRaw;
}

SearchParams params_for(const MatcherOptions& options, int width, const Kernel& kernel) {
  SearchParams params{};
  params.arithmetic = fitting_arithmetic(options);
  params.width = width;
  params.min_disparity = options.min_disparity;
  params.disparities = options.disparities;
  params.window = options.window;
  if (params.arithmetic == Arithmetic::kWide) {
    params.chunks = 1;
    params.chunk =
        (options.disparities + kernels::kMaxVector - 1) / kernels::kMaxVector * kernels::kMaxVector;
  } else {
    params.chunks = (options.disparities + kernels::kMaxChunk - 1) / kernels::kMaxChunk;
    params.chunk = kernel.chunk_for((options.disparities + params.chunks - 1) / params.chunks);
  }
  params.recompute = resolve_cache_use(options.cache) == CacheUse::kSmall;
  params.neighbors = options.subpixel;
  params.uniqueness_ratio = options.uniqueness_ratio;
  return params;
}

// Tiles overlap by window − 1 columns and have winners in whole blocks of columns: at least one block,
// because the overlap would dominate smaller tiles. In a cache of 24 KiB, 20 KiB of column sums leave room
// for the input rows.
std::vector<ColumnTile> tiles_for(const SearchParams& params) {
  const int overlap = params.window - 1;
  int tile_winners = params.columns() - overlap;
  if (params.recompute) {
    constexpr int kSumBytes = 20 * 1024;
    const int columns = kSumBytes / (2 * params.padded_disparities()) - overlap;
    tile_winners = std::max(1, columns / kernels::kBlockColumns) * kernels::kBlockColumns;
  }
  std::vector<ColumnTile> tiles;
  for (int first = 0; first < params.columns() - overlap; first += tile_winners) {
    tiles.push_back({first, std::min(first + tile_winners + overlap, params.columns())});
  }
  return tiles;
}

std::size_t as_size(int value) { return static_cast<std::size_t>(value); }

class SimdSearch final : public RowSearch {
  static_assert(kernels::kBlockColumns <= RowWinners::kMargin);

 public:
  SimdSearch(const MatcherOptions& options, int width)
      : options_(options),
        kernel_(kernel_for(resolve_isa(options.isa))),
        params_(params_for(options, width, kernel_)),
        tiles_(tiles_for(params_)),
        right_rows_(params_.right_row_bytes(), params_.recompute ? params_.window + kBatchRows : 1),
        left_rows_(as_size(params_.recompute ? params_.window + kBatchRows : 1)),
        zeros_(params_.recompute ? as_size(params_.right_row_bytes()) : difference_row_bytes()),
        differences_(params_.recompute ? 0 : as_size(params_.window + 1) * difference_row_bytes()),
        block_sums_(as_size(kernels::kBlockColumns) * as_size(params_.block_step()) + 2 * kBlockMargin) {
    std::fill_n(block_sums_.data(), block_sums_.size(), kernel_.no_sum);
    for (const ColumnTile& tile : tiles_) {
      column_sums_.emplace_back(as_size(params_.window + tile.columns()) *
                                as_size(params_.padded_disparities()));
    }
  }

  void reset() noexcept override {
    for (auto& sums : column_sums_) sums.fill_zero();
    next_row_ = 0;
  }

  int batch_size() const noexcept override { return params_.recompute ? kBatchRows : 1; }

  void add_rows(std::span<const SearchRow> rows) noexcept override {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const int y = next_row_ + static_cast<int>(i);
      left_rows_[as_size(y) % left_rows_.size()] = rows[i].left + params_.min_disparity;
      kernel_.prepare_right_row(params_, rows[i].right, right_rows_.row(y));
    }
    for (std::size_t s = 0; s < tiles_.size(); ++s) {  // from left to right, as Winners requires
      for (std::size_t i = 0; i < rows.size(); ++i)
        add_row(s, next_row_ + static_cast<int>(i), rows[i].winners);
    }
    next_row_ += static_cast<int>(rows.size());
  }

  void write(const RowWinners& winners, std::int16_t* out) const noexcept override {
    if (!options_.subpixel) return write_disparities(winners, options_, out);
    const auto first = as_size(winners.first);
    kernel_.interpolate(winners.index.data() + first, winners.cost.data() + first,
                        winners.before.data() + first, winners.after.data() + first,
                        winners.end - winners.first, options_.min_disparity, options_.disparities,
                        out + first);
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
  static constexpr int kBatchRows = 16;  // rows added to a tile while its sums are in the cache
  // The neighbors of the first and the last disparity may be read.
  static constexpr std::size_t kBlockMargin = 64;

  std::size_t difference_row_bytes() const {
    return as_size(params_.columns()) * as_size(params_.padded_disparities());
  }

  std::uint8_t* differences(int y) {
    return differences_.data() + as_size(y % (params_.window + 1)) * difference_row_bytes();
  }

  kernels::InputRow input_row(int y) const {
    return {left_rows_[as_size(y) % left_rows_.size()], right_rows_.row(y)};
  }

  void add_row(std::size_t tile, int y, RowWinners* winners) noexcept {
    kernels::RowChange change{input_row(y), {}, nullptr, nullptr};
    const int leaving = y - params_.window;
    if (params_.recompute) {
      change.removed = leaving >= 0 ? input_row(leaving) : kernels::InputRow{zeros_.data(), zeros_.data()};
    } else {
      change.differences = differences(y);
      change.removed_differences = leaving >= 0 ? differences(leaving) : zeros_.data();
    }
    const kernels::Scratch scratch{column_sums_[tile].data(), block_sums_.data() + kBlockMargin};
    if (winners == nullptr) return kernel_.add_row(params_, tiles_[tile], change, scratch);
    const auto first = as_size(winners->first);
    kernel_.search_row(
        params_, tiles_[tile], change, scratch,
        {winners->index.data() + first, winners->cost.data() + first, winners->before.data() + first,
         winners->after.data() + first, winners->ambiguous.data() + first});
  }

  MatcherOptions options_;
  const Kernel& kernel_;
  SearchParams params_;
  std::vector<ColumnTile> tiles_;                          // one of all columns, unless params_.recompute
  RowRing<std::uint8_t> right_rows_;                       // as Kernel::prepare_right_row writes them
  std::vector<const std::uint8_t*> left_rows_;             // row y is at index y % size
  AlignedBuffer<std::uint8_t> zeros_;                      // the row that leaves the window while it fills
  AlignedBuffer<std::uint8_t> differences_;                // of the last `window` + 1 rows, by turns
  std::vector<AlignedBuffer<std::uint16_t>> column_sums_;  // one buffer a tile
  AlignedBuffer<std::uint16_t> block_sums_;
  int next_row_ = 0;
};

}  // namespace

std::unique_ptr<RowSearch> make_simd_search(const MatcherOptions& options, int width) {
  return std::make_unique<SimdSearch>(options, width);
}

}  // namespace stereod
