// SPDX-License-Identifier: BSD-3-Clause
// The interface between the semi-global matcher and its kernels, one for each instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/cpu.h"
#include "core/match/disparity.h"
#include "core/match/semiglobal/subsampled_disparity.h"

namespace stereod::semiglobal {

/// Planes that describe a row of pixels: the lower and the upper half (nibble) of the census, the gradient.
inline constexpr int kPlanes = 3;
/// Columns beyond the last one that smoothing along the row reads.
inline constexpr int kColumnPadding = 3;
/// Maximum number of vectors that hold the disparities of one sample.
inline constexpr int kMaxVectors = 16;
/// Pixels that the census reads to each side, and rows up and down.
inline constexpr int kCensusReach = 2;
/// Grid rows above and below a grid row that its costs are smoothed with.
inline constexpr int kSmoothReach = 2;

/// What stays the same during the life of a matcher. The disparities of a sample are striped: number k lies
/// in vector k % vectors at lane k / vectors, so that a neighboring disparity is mostly in a neighboring
/// vector at the same lane. The numbers from `disparities` on are padding, at the ends of the vectors.
struct SearchParams {
  int width;  ///< [px] of the image
  int min_disparity;
  int disparities;
  int vectors;       ///< 1…kMaxVectors
  int lanes;         ///< bytes in a vector
  int decimation_x;  ///< image columns a sample: 2 on the coarse grid, 1 on the fine one
  int gradient_limit;
  int p1;

  int grid_width() const { return (width + decimation_x - 1) / decimation_x; }
  /// Returns the bytes of the costs of one sample.
  int sample_bytes() const { return vectors * lanes; }
  /// Returns the bytes of one plane of a row of pixels: at least kColumnPadding more than the image is wide.
  int row_bytes() const { return (width + kColumnPadding + 63) / 64 * 64; }
  /// Returns the bytes of one of the `vectors` stripes of a plane, see Kernel::stripe_row.
  int stripe_bytes() const { return (row_bytes() + vectors) / vectors + lanes + 16; }
  /// Returns where the byte of disparity number @p k lies among the costs of a sample.
  int lane_offset(int k) const { return k % vectors * lanes + k / vectors; }
};

/// Input and output of Kernel::cost_row. `tables` and `costs` are aligned to whole vectors.
struct CostRow {
  /// [kPlanes][row_bytes()] of the left row, census nibbles times 16; the last pixel is repeated
  /// kColumnPadding times.
  const std::uint8_t* left;
  const std::uint8_t* right;  ///< [kPlanes][vectors][stripe_bytes()] of the right row, see Kernel::stripe_row
  const std::uint8_t* tables;   ///< [16 left nibbles][16 right nibbles] costs
  const std::int32_t* offsets;  ///< [width + kColumnPadding][vectors] where in the stripes the matches begin
  /// [grid_width()][sample_bytes()]; the memory of one sample before and after it may be overwritten.
  std::uint8_t* costs;
};

/// Input and output of the path functions: two grid rows, computed by turns to hide latencies.
struct PathRows {
  const std::uint8_t*
      costs[2 * kSmoothReach + 2];  ///< of the grid rows from kSmoothReach before the first on
  const std::uint8_t* padding;      ///< [sample_bytes()] 255 for the padding, 0 for disparities
  const std::uint8_t* p2[2];  ///< of the step between each sample and its left neighbor; element 0 is unused
  std::uint8_t* smoothed[2];  ///< costs smoothed over rows
  std::uint8_t* sums[2];      ///< of the paths
  std::uint16_t* winners[2];  ///< minimum sum · 256 + the first lane that has it in some vector
};

/// The winners of a grid row; one vector more than its samples can be read.
struct WinnerRow {
  const std::uint16_t* winners;                        ///< as in PathRows
  const std::uint8_t *index, *sum_before, *sum_after;  ///< the winner's k, the sums of k − 1 and k + 1
};

/// The functions of one instruction set. Rows may have any alignment; costs, sums and padding are aligned to
/// whole vectors. docs/matcher.md, part 2, defines what each function computes.
struct Kernel {
  int lanes;

  /// Writes the census (section 2.1) of a row of pixels: two planes of @p row_bytes bytes, each nibble
  /// shifted left by @p shift [0 or 4]. @p rows are the five rows from two above to two below; kCensusReach
  /// pixels to the left and to the right of each can be read.
  void (*census_row)(const std::uint8_t* const* rows, int row_bytes, int shift, std::uint8_t* out);

  /// xsobel_row() of core/match/block/prefilter.h.
  void (*xsobel_row)(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int width,
                     int cap, std::uint8_t* out);

  /// Writes a plane of row_bytes() pixels in reverse order, so that growing disparity means growing address,
  /// and cut into `vectors` stripes: pixel i of the reversed row goes to stripe i % vectors. The bytes after
  /// the pixels stay: they mark what lies outside the image. @p scratch has 2·row_bytes() bytes.
  void (*stripe_row)(const SearchParams&, const std::uint8_t* plane, std::uint8_t* scratch,
                     std::uint8_t* out);

  /// Writes the costs of a grid row, smoothed along it (section 2.1).
  void (*cost_row)(const SearchParams&, const CostRow&);

  /// Smooths costs over rows and writes the sums of the paths from the right (section 2.2).
  void (*paths_from_right)(const SearchParams&, const PathRows&);

  /// Adds the sums of the paths from the left and writes the winners (section 2.2).
  void (*paths_from_left)(const SearchParams&, const PathRows&);

  /// Counts for each sample the sums that are ≤ its limit.
  void (*count_less_equal)(const SearchParams&, const std::uint8_t* sums, const std::uint8_t* limits,
                           std::int16_t* counts);

  /// Writes the winners as disparities in 1/16 px (section 2.3), kNoDisparity for those outside the right
  /// image. Rows of disparities have kDisparityMargin, here and below.
  void (*refine_winners)(const SearchParams&, const WinnerRow&, SubsampledDisparity* out);

  /// Writes the 3×3 median of a grid row with the exception for thin upright things (section 2.5). The first
  /// and the last column are copied. Samples without a disparity get one only if @p fill, marked as filled.
  void (*median_row)(const SubsampledDisparity* above, const SubsampledDisparity* row,
                     const SubsampledDisparity* below, int width, bool fill, SubsampledDisparity* out);

  /// Writes the guide of an image row of the left image, one byte a pixel, for upsample_columns() and
  /// interpolate_rows(): which of its left and right neighbors a pixel of @p row resembles more in gray
  /// value, and which of its upper (@p row) and lower (@p after) neighbors a pixel of @p next. Reads up to 32
  /// pixels on both sides of the rows and writes up to 32 bytes past the end.
  void (*guide_row)(const std::uint8_t* row, const std::uint8_t* next, const std::uint8_t* after, int width,
                    std::uint8_t* out);

  /// Writes a disparity for every image column from the samples of a coarse grid row: between two samples as
  /// interpolate_rows() does. Overwrites the element after @p row.
  void (*upsample_columns)(SubsampledDisparity* row, int image_width, const std::uint8_t* guide,
                           SubsampledDisparity* out);

  /// Writes the row between two rows of disparities, column by column (section 2.5): the mean if the two
  /// differ by less than 1.5 px, else the one whose pixel resembles the pixel between them more, the lower
  /// one if both do alike; the known one if only one is known. @p guide is that of the row of @p a.
  void (*interpolate_rows)(const SubsampledDisparity* a, const SubsampledDisparity* b, int width,
                           const std::uint8_t* guide, SubsampledDisparity* out);

  /// Writes disparities as BandMatcher gives them (core/match/disparity.h).
  void (*write_disparities)(const SubsampledDisparity* row, int width, const OutputParams&,
                            std::int16_t* out);

  /// Writes, for each sample, P2 of the step from its left neighbor: max(0, p2 − |gray step|). @p step [1 or
  /// 2] image columns a sample. Reads and writes up to 32 elements past the last sample; element 0 is
  /// undefined.
  void (*adapt_p2)(const std::uint8_t* gray, int width, int step, int p2, std::uint8_t* out);
};

/// Returns the kernel of @p isa, a result of resolve_isa().
const Kernel& kernel_for(Isa isa);

extern const Kernel kScalarKernel;
#if defined(__x86_64__) || defined(__i386__)
extern const Kernel kSsse3Kernel;
extern const Kernel kSse41Kernel;
extern const Kernel kAvx2Kernel;
#endif
#if defined(__aarch64__) || defined(__ARM_NEON)
extern const Kernel kNeonKernel;
#endif

}  // namespace stereod::semiglobal
