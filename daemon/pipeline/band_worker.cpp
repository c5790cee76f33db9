#include "daemon/pipeline/band_worker.h"

#include <algorithm>

#include "daemon/pipeline/clocks.h"

namespace stereod {

BandWorker::BandWorker(const MatcherOptions& options, Size size)
    : matcher_(make_band_matcher(options, size)) {}

void BandWorker::run(const Job& job, RowRange blocks) noexcept {
  rectify_ns_ = match_ns_ = 0;
  next_block_ = blocks.first;
  const RowRange band{job.publisher.block_rows(blocks.first).first,
                      job.publisher.block_rows(blocks.end - 1).end};
  matcher_->use_masks(&job.left_mask, &job.right_mask);
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
    job.left_map.grey_row(job.pair.left.frame().luma.data, y, matcher_->left_row(y));
    job.right_map.grey_row(job.pair.right.frame().luma.data, y, matcher_->right_row(y));
    // Rows around the band are the neighbour's to copy.
    if (job.left_image == nullptr || y < band.first || y >= band.end) continue;
    std::copy_n(matcher_->left_row(y), job.left_image->width(), job.left_image->row(y));
  }
}

void BandWorker::match_rows(const Job& job, RowRange rows) noexcept {
  DisparityImage& disparity = job.output.disparity;
  for (int y = rows.first; y < rows.end; ++y) {
    const RowRange done = matcher_->push(y);
    for (int row = done.first; row < done.end; ++row) {
      std::copy_n(matcher_->disparity_row(row), disparity.width(), disparity.row(row));
    }
    if (!job.announce) continue;
    while (next_block_ < job.publisher.blocks() && job.publisher.block_rows(next_block_).end <= done.end) {
      job.publisher.block_final(job.output, next_block_++);
    }
  }
}

}  // namespace stereod
