// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pipeline/band_worker.h"

#include <algorithm>

#include "daemon/base/clocks.h"

namespace stereod {

BandWorker::BandWorker(const MatcherOptions& options, Size size, ColumnRange wanted)
    : wanted_(wanted),
      matched_(columns_to_match(options, size, wanted)),
      whole_row_(matched_.count() < size.width ? GrayImage(size.width, 1) : GrayImage()),
      matcher_(make_band_matcher(options, {matched_.count(), size.height})) {}

void BandWorker::run(const Job& job, RowRange blocks) noexcept {
  rectify_ns_ = match_ns_ = 0;
  next_block_ = blocks.first;
  const RowRange band{job.publisher.block_rows(blocks.first).first,
                      job.publisher.block_rows(blocks.end - 1).end};
  matcher_->use_masks(&job.left.matched_mask(), &job.right.matched_mask());
  const RowRange input = matcher_->begin(band);
  for (int y = input.first; y < input.end; y += BandMatcher::kRowsAhead) {
    const RowRange rows{y, std::min(y + BandMatcher::kRowsAhead, input.end)};
    const std::int64_t begin = monotonic_ns();
    rectify_rows(job, band, rows);
    const std::int64_t rectified = monotonic_ns();
    match_rows(job, rows);
    rectify_ns_ += rectified - begin;
    match_ns_ += monotonic_ns() - rectified;
  }
}

void BandWorker::rectify_rows(const Job& job, RowRange band, RowRange rows) noexcept {
  for (int y = rows.first; y < rows.end; ++y) {
    const std::uint8_t* left = rectify_row(job.left.map(), job.pair.left, y, matcher_->left_row(y));
    // The rows around the band belong to the neighboring workers.
    if (job.left_image != nullptr && y >= band.first && y < band.end) {
      std::copy_n(left, job.left_image->width(), job.left_image->row(y));
    }
    rectify_row(job.right.map(), job.pair.right, y, matcher_->right_row(y));
  }
}

// Writes the matched columns to @p out. Returns the whole row.
const std::uint8_t* BandWorker::rectify_row(const RectifyMap& map, const FrameLease& frame, int y,
                                            std::uint8_t* out) noexcept {
  if (whole_row_.empty()) {
    map.gray_row(frame.frame().luma.data, y, out);
    return out;
  }
  map.gray_row(frame.frame().luma.data, y, whole_row_.row(0));
  std::copy_n(whole_row_.row(0) + matched_.first, matched_.count(), out);
  return whole_row_.row(0);
}

void BandWorker::match_rows(const Job& job, RowRange rows) noexcept {
  DisparityImage& disparity = job.output.disparity;
  for (int y = rows.first; y < rows.end; ++y) {
    const RowRange done = matcher_->push(y);
    for (int row = done.first; row < done.end; ++row) {
      std::copy_n(matcher_->disparity_row(row) + (wanted_.first - matched_.first), wanted_.count(),
                  disparity.row(row) + wanted_.first);
    }
    if (!job.announce) continue;
    while (next_block_ < job.publisher.blocks() && job.publisher.block_rows(next_block_).end <= done.end) {
      job.publisher.block_final(job.output, next_block_++);
    }
  }
}

}  // namespace stereod
