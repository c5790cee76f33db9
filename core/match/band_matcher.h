// SPDX-License-Identifier: BSD-3-Clause
// The interface of a matcher: bands of rows go in row by row, disparity rows come out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "core/base/validity_mask.h"
#include "core/match/disparity.h"
#include "core/match/options.h"

namespace stereod {

/// Matches one band of rows of a rectified pair at a time. Each worker owns one: it holds all scratch memory
/// and shares nothing. Allocates and throws only during construction, except the reference of the semi-global
/// matcher, which allocates for each band.
///
/// A band is matched as follows:
///
///   rows = begin({first, end});            the input rows to write: the band with its halo above and below
///   for y in rows:
///     write row y of the pair to left_row(y) and right_row(y);
///     final = push(y);                     often empty or one row; several at the bottom of the image
///     read disparity_row(f) for f in final;
///
/// Up to kRowsAhead rows may be written before they are pushed. The result does not depend on where the image
/// was cut into bands. begin() may be called before the band before is complete.
class BandMatcher {
 public:
  static constexpr int kRowsAhead = 16;

  virtual ~BandMatcher() = default;

  /// Sets the masks of both images from the next begin() on: a pixel becomes invalid if it has no source in
  /// the left image, or if its match has none in the right one. Null takes all pixels for valid. The masks
  /// have the size of the image and must outlive their use.
  virtual void use_masks(const ValidityMask* left, const ValidityMask* right) noexcept = 0;

  /// Starts the band of @p rows (not empty, inside the image). Returns the input rows that it needs.
  virtual RowRange begin(RowRange rows) noexcept = 0;

  /// Return where to write the `width` pixels of input row @p y.
  virtual std::uint8_t* left_row(int y) noexcept = 0;
  virtual std::uint8_t* right_row(int y) noexcept = 0;

  /// Takes input row @p y, in order and without gaps. Returns the output rows that became final, which may be
  /// none.
  virtual RowRange push(int y) noexcept = 0;
  /// Returns the disparities of row @p y (core/match/disparity.h), one of those that the last push()
  /// returned. Valid until the next push().
  virtual const std::int16_t* disparity_row(int y) const noexcept = 0;

  /// Returns the bytes of scratch memory that the matcher holds.
  virtual std::size_t scratch_bytes() const noexcept = 0;
};

/// Returns the matcher of @p options for images of size @p image [1…32767 px a side].
/// @throws std::invalid_argument with the text of problem_with(), or if the size is out of range, or if the
/// CPU lacks the instruction set.
std::unique_ptr<BandMatcher> make_band_matcher(const MatcherOptions& options, Size image);

}  // namespace stereod
