// SPDX-License-Identifier: BSD-3-Clause
// Rows, halos and rings: what the stages of a band matcher have in common.
//
// A matcher is a chain of stages that turn rows into rows:
//
//   block       input rows → prefilter → search → median → disparity rows
//   semiglobal  input rows → costs → paths → median → upsampling → disparity rows
//
// A stage says one number, its border: how many rows above and below it reads for one row. From the borders
// follows all that the chain has to know:
//
//   * The halo of a band. RowStage::begin() is called from the last stage to the first. Each call grows the
//     wanted rows by the border, and the result is what the stage before has to make; the result of the first
//     stage is the input that the band needs.
//   * When a row can be made. After each input row, RowStage::ready() is asked from the first stage to the
//     last.
//   * How many rows are kept. A RowRing between two stages holds 2·border + 1 rows, and more where a stage
//     takes or makes several rows at once.
//
// A band's result does not depend on where the image was cut, because every stage clips its border only where
// the image ends. (libjxl's render pipeline has the same split between stages and the owner of rows.)
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "core/base/image.h"

namespace stereod {

/// Keeps the last `capacity` rows of an image: row y overwrites row y − capacity.
template <typename Pixel>
class RowRing {
 public:
  /// Allocates @p capacity [≥ 1] zeroed rows of @p width pixels, each with @p margin further pixels on both
  /// sides that stages may read and write.
  RowRing(int width, int capacity, int margin = 0) : rows_(width + 2 * margin, capacity), margin_(margin) {}

  /// Returns the first pixel of row @p y [≥ 0].
  Pixel* row(int y) noexcept {
    assert(y >= 0);
    return rows_.row(y % rows_.height()) + margin_;
  }
  const Pixel* row(int y) const noexcept { return rows_.row(y % rows_.height()) + margin_; }

  /// Sets every pixel of every row, margins included, to @p value.
  void fill(Pixel value) noexcept {
    for (int i = 0; i < rows_.height(); ++i) std::fill_n(rows_.row(i), rows_.width(), value);
  }

  std::size_t bytes() const noexcept {
    return static_cast<std::size_t>(rows_.view().stride()) * static_cast<std::size_t>(rows_.height());
  }

 private:
  Image<Pixel> rows_;
  int margin_;
};

/// Says for one stage which rows it makes for the current band, and when the next one can be made.
class RowStage {
 public:
  /// A stage that reads, for its row r, the rows scale·r − @p border … scale·r + @p border of the stage
  /// before. @p scale [1 or 2] is 2 where the stage works on every second row of its input.
  explicit RowStage(int border, int scale = 1) : border_(border), scale_(scale) {}

  /// Starts a band: the stage is to make @p rows. Returns the rows that it reads, clipped to those that the
  /// stage before can make, @p available.
  RowRange begin(RowRange rows, RowRange available) noexcept {
    next_ = rows.first;
    end_ = rows.end;
    input_ = grown({scale_ * rows.first, scale_ * (rows.end - 1) + 1}, border_, available);
    return input_;
  }

  /// Starts a band in which the stage makes @p rows without reading any.
  void begin_without_input(RowRange rows) noexcept {
    next_ = rows.first;
    end_ = rows.end;
    input_ = {scale_ * rows.first, scale_ * rows.first};
  }

  /// Returns whether the next @p rows [1 or 2] rows can be made once the stage before has made its rows below
  /// @p input_end. They can if all rows that they read are there, if the stage before makes no more rows, or
  /// if the row lies before the first one that can be read, so that it reads none.
  bool ready(int input_end, int rows = 1) const noexcept {
    const int last_read = scale_ * (next_ + rows - 1) + border_;
    return next_ < end_ &&
           (last_read < input_end || input_end >= input_.end || next_ * scale_ < input_.first);
  }

  /// Returns the number of the next row and counts it as made.
  int take() noexcept { return next_++; }

  /// Returns the end of the rows made so far.
  int made_end() const noexcept { return next_; }
  /// Returns the end of the rows to make.
  int end() const noexcept { return end_; }
  /// Returns the rows that the stage reads in this band.
  RowRange input() const noexcept { return input_; }

 private:
  int border_, scale_;
  int next_ = 0, end_ = 0;
  RowRange input_{};
};

/// Returns the row that stands for row @p y of an image of @p height rows: itself, or, one row beyond the top
/// or the bottom, the row mirrored at the edge row. An image of one row stands for itself.
inline int mirrored_row(int y, int height) noexcept {
  if (y < 0) return std::min(-y, height - 1);
  return y < height ? y : std::max(2 * (height - 1) - y, 0);
}

/// Returns the number of the row nearest to @p y in an image of @p height rows.
inline int clamped_row(int y, int height) noexcept { return std::clamp(y, 0, height - 1); }

}  // namespace stereod
