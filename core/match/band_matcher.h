// The seam between a matcher and whoever feeds it: bands of rows go in row by row, disparity rows come out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "core/base/validity_mask.h"
#include "core/match/disparity.h"
#include "core/match/options.h"

namespace stereod {

/// Matches one band of a rectified pair at a time. Each worker owns one; it holds all scratch memory and
/// shares nothing. After construction it allocates nothing and throws nothing (but for the naive semi-global
/// one, which is a definition to compare with).
///
/// A band goes like this:
///   rows = begin({first, end});            the input rows it wants, with the halo above and below
///   for y in rows:
///     write the pair's row y to left_row(y) and right_row(y);
///     final = push(y);                     often empty or one row; at the bottom of the image several
///     read disparity_row(f) for f in final;
/// Up to kRowsAhead rows may be written before they are pushed. A band's answer does not depend on where the
/// image was cut.
class BandMatcher {
 public:
  static constexpr int kRowsAhead = 16;

  virtual ~BandMatcher() = default;

  /// From the next begin() on, no pixel gets an answer that is not valid in the left mask, or whose match is
  /// not in the right one. Null: all are. The masks are of the image's size and outlive their use.
  virtual void use_masks(const ValidityMask* left, const ValidityMask* right) noexcept = 0;

  /// Starts the band that answers for `rows` (not empty, inside the image) and returns the input rows it
  /// needs.
  virtual RowRange begin(RowRange rows) noexcept = 0;

  /// Where to write `width` pixels of input row y.
  virtual std::uint8_t* left_row(int y) noexcept = 0;
  virtual std::uint8_t* right_row(int y) noexcept = 0;

  /// Takes input row y, in order and without gaps; returns the output rows that became final by it. Their
  /// memory is valid until the next push().
  virtual RowRange push(int y) noexcept = 0;
  virtual const std::int16_t* disparity_row(int y) const noexcept = 0;

  /// Bytes of scratch memory it holds.
  virtual std::size_t scratch_bytes() const noexcept = 0;
};

/// The matcher that the options ask for, for images of this size (1 to 32767 pixels a side). Throws
/// std::invalid_argument with the sentence of problem_with(), or with one that says what the size is, or what
/// is missing if the CPU lacks the instruction set.
std::unique_ptr<BandMatcher> make_band_matcher(const MatcherOptions& options, Size image);

}  // namespace stereod
