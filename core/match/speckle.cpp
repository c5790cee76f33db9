// SPDX-License-Identifier: BSD-3-Clause
#include "core/match/speckle.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <utility>

namespace stereod {
namespace {

static_assert(std::endian::native == std::endian::little);  // the first of eight bytes is the lowest

std::size_t as_index(std::int32_t i) { return static_cast<std::size_t>(i); }

// Returns the disparity that connects a pixel with its neighbors, measured or filled in.
std::int16_t disparity_of(std::int16_t value) { return is_filled(value) ? filled_disparity(value) : value; }

}  // namespace

SpeckleFilter::SpeckleFilter(Size image)
    : size_(image),
      runs_(as_index(image.width) * as_index(image.height)),
      row_first_run_(as_index(image.height) + 1),
      cuts_(as_index(image.width) + kMarks) {}

void SpeckleFilter::apply(ImageView<std::int16_t> disparity, int max_size, int max_step) noexcept {
  assert(disparity.size() == size_);
  run_count_ = 0;
  for (int y = 0; y < size_.height; ++y) {
    row_first_run_[as_index(y)] = run_count_;
    cut_row(disparity.row(y), max_step);
    row_first_run_[as_index(y) + 1] = run_count_;
    if (y > 0) join_rows(disparity.row(y - 1), disparity.row(y), y, max_step);
  }
  for (int y = 0; y < size_.height; ++y) {
    for (std::int32_t i = row_first_run_[as_index(y)]; i < row_first_run_[as_index(y) + 1]; ++i) {
      if (runs_[as_index(root_of(i))].size > max_size) continue;
      std::fill(disparity.row(y) + runs_[as_index(i)].first, disparity.row(y) + runs_[as_index(i)].end,
                kInvalidDisparity);
    }
  }
}

void SpeckleFilter::cut_row(const std::int16_t* row, int max_step) noexcept {
  mark_cuts(row, max_step);
  int first = 0;
  const auto end_run = [&](int end) {
    if (row[first] != kInvalidDisparity) {
      runs_[as_index(run_count_)] = {run_count_, end - first, static_cast<std::int16_t>(first),
                                     static_cast<std::int16_t>(end)};
      ++run_count_;
    }
    first = end;
  };
  for (int x = 0; x < size_.width; x += kMarks) {
    std::uint64_t marks = 0;  // of eight pixels; mostly 0
    std::memcpy(&marks, cuts_.data() + x, sizeof(marks));
    for (; marks != 0; marks &= marks - 1) end_run(x + std::countr_zero(marks) / 8);
  }
  end_run(size_.width);
}

// Sets cuts_[x] to 1 where pixel x is not connected with x − 1: only one of them is invalid, or the step is
// too large.
void SpeckleFilter::mark_cuts(const std::int16_t* row, int max_step) noexcept {
  const int width = size_.width;
  const auto limit =
      static_cast<std::int16_t>(std::min<int>(max_step, std::numeric_limits<std::int16_t>::max()));
  std::uint8_t* __restrict cuts = cuts_.data();
  for (int x = 1; x < width; ++x) {
    const std::int16_t here = disparity_of(row[x]);
    const std::int16_t before = disparity_of(row[x - 1]);
    const auto up = static_cast<std::int16_t>(here - before);
    const auto down = static_cast<std::int16_t>(before - here);
    const auto step = up > down ? up : down;
    // too_far is negative where the step is too large; edge is negative where only one of the pixels is
    // invalid, because only invalid ones are negative.
    const auto too_far = static_cast<std::int16_t>(limit - step);
    const auto edge = static_cast<std::int16_t>(here ^ before);
    cuts[x] = static_cast<std::uint8_t>(static_cast<std::uint16_t>(too_far | edge) >> 15);
  }
}

// Unites the runs of rows y − 1 and y that touch.
void SpeckleFilter::join_rows(const std::int16_t* upper, const std::int16_t* lower, int y,
                              int max_step) noexcept {
  std::int32_t above = row_first_run_[as_index(y) - 1];
  std::int32_t below = row_first_run_[as_index(y)];
  while (above < row_first_run_[as_index(y)] && below < row_first_run_[as_index(y) + 1]) {
    const Run& a = runs_[as_index(above)];
    const Run& b = runs_[as_index(below)];
    const int end = std::min(a.end, b.end);
    for (int x = std::max(a.first, b.first); x < end; ++x) {
      if (std::abs(disparity_of(upper[x]) - disparity_of(lower[x])) <= max_step) {
        unite(above, below);
        break;
      }
    }
    const bool above_ends_first = a.end <= b.end;
    const bool below_ends_first = b.end <= a.end;
    if (above_ends_first) ++above;
    if (below_ends_first) ++below;
  }
}

std::int32_t SpeckleFilter::root_of(std::int32_t run) noexcept {
  while (runs_[as_index(run)].parent != run) {
    runs_[as_index(run)].parent = runs_[as_index(runs_[as_index(run)].parent)].parent;  // path halving
    run = runs_[as_index(run)].parent;
  }
  return run;
}

void SpeckleFilter::unite(std::int32_t a, std::int32_t b) noexcept {
  a = root_of(a);
  b = root_of(b);
  if (a == b) return;
  if (runs_[as_index(a)].size < runs_[as_index(b)].size) std::swap(a, b);
  runs_[as_index(b)].parent = a;
  runs_[as_index(a)].size += runs_[as_index(b)].size;
}

}  // namespace stereod
