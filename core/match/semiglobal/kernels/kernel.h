// The interface between the semi-global matcher and its kernels, one for each instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/match/disparity.h"
#include "core/match/options.h"
#include "core/match/semiglobal/subsampled_disparity.h"

namespace stereod::semiglobal {

/// A pixel is compared by two nibbles of comparisons with its neighbors and by its gradient.
inline constexpr int kPlanes = 3;
/// Columns that are smoothed beyond the last one.
inline constexpr int kBeyond = 3;
/// Vectors that the disparities of a point are spread over at most.
inline constexpr int kMaxVectors = 16;
/// Pixels that the census looks at to the left and to the right, and rows up and down.
inline constexpr int kCensusReach = 2;
/// Rows of the grid that are smoothed into one, less the middle one, by two.
inline constexpr int kSmoothReach = 2;

/// What is fixed for a matcher. The disparities of a point lie striped: number k stands in vector k % vectors
/// at lane k / vectors, so that a neighboring disparity is mostly in a neighboring vector, at the same
/// lane. Those there only to fill up the vectors are the last ones of the last lanes.
struct Shape {
  int width;  ///< of the image, px
  int min_disparity;
  int disparities;
  int vectors;       ///< 1…kMaxVectors
  int lanes;         ///< bytes in a vector
  int decimation_x;  ///< 2 on the coarse grid, 1 on the fine one
  int gradient_limit;
  int p1;
  int grid_width() const { return (width + decimation_x - 1) / decimation_x; }
  /// Bytes of the costs of a point.
  int point_bytes() const { return vectors * lanes; }
  /// Bytes of a plane of a row of pixels, at least kBeyond more than there are, and of one that runs
  /// backwards in stripes. The stripes begin with the last of row_bytes() pixels; after the first one come
  /// marks for what lies outside.
  int row_bytes() const { return (width + kBeyond + 63) / 64 * 64; }
  int stripe_bytes() const { return (row_bytes() + vectors) / vectors + lanes + 16; }
  int place(int disparity) const { return disparity % vectors * lanes + disparity / vectors; }
};

/// Costs of a row of the grid smoothed along it, from its first point on; a point's worth of memory before
/// and after it may be written.
struct CostRow {
  const std::uint8_t*
      left;  ///< [plane][row_bytes()], nibbles times 16; the last pixel is repeated kBeyond times
  const std::uint8_t* right;    ///< [plane][vectors][stripe_bytes()]
  const std::uint8_t* tables;   ///< [16 left nibbles][16 right nibbles]: costs; 64-byte aligned
  const std::int32_t* offsets;  ///< [width + kBeyond][vectors]: where in the stripes matches begin
  std::uint8_t* costs;
};

/// Two rows of the grid, which the kernel works on by turns to hide latencies.
struct PathRows {
  const std::uint8_t* costs[2 * kSmoothReach + 2];  ///< of the rows from two before the first on
  const std::uint8_t* padding;  ///< [point_bytes()]: 255 for disparities that only fill up, else 0
  const std::uint8_t* p2[2];    ///< for the step from the point to the left; element 0 is not looked at
  std::uint8_t* smoothed[2];    ///< costs smoothed over rows
  std::uint8_t* sums[2];        ///< of the paths
  std::uint16_t* winners[2];    ///< least sum · 256 + the first lane that has it in some vector
};

/// What is known of the winners of a row of points; a vector's worth more can be read.
struct WinnerRow {
  const std::uint16_t* winners;                        ///< as in PathRows
  const std::uint8_t *index, *sum_before, *sum_after;  ///< the winning disparity, the sums beside it
};

/// One instruction set's kernel. The functions take rows of any alignment; costs, sums and padding are
/// 64-byte aligned.
struct Kernel {
  int lanes;

  /// The census of a row of pixels, in two planes of `row_bytes` bytes, each nibble shifted left by `shift`
  /// (0 or 4). `rows` are five, two above it to two below; of each, kCensusReach pixels to the left and to
  /// the right of `row_bytes` can be read.
  void (*census_row)(const std::uint8_t* const* rows, int row_bytes, int shift, std::uint8_t* out);

  /// xsobel_row() of core/match/block/prefilter.h.
  void (*xsobel_row)(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int width,
                     int cap, std::uint8_t* out);

  /// A plane of a row backwards and in stripes. `scratch` has two times row_bytes().
  void (*stripe_row)(const Shape&, const std::uint8_t* plane, std::uint8_t* scratch, std::uint8_t* out);

  void (*cost_row)(const Shape&, const CostRow&);

  /// Smooths costs over rows and sums up the paths from the right.
  void (*paths_from_right)(const Shape&, const PathRows&);

  /// Adds the paths from the left and finds the winners.
  void (*paths_from_left)(const Shape&, const PathRows&);

  /// How many of the sums of each point of a row are at most its limit.
  void (*count_at_most)(const Shape&, const std::uint8_t* sums, const std::uint8_t* limits,
                        std::int16_t* counts);

  /// The winners as values, to 1/16 px by a parabola-like fit (section 2.3 of docs/matcher.md); none for
  /// those outside the right image. Rows of values, here and below, have kValueMargin.
  void (*interpolate_row)(const Shape&, const WinnerRow&, GridValue* out);

  /// Median of the 3×3 values around each, or of the three of its column where that one is more than 1.5 px
  /// nearer and less than 0.5 px from another of the three: what is thin and upright has no majority of nine.
  /// The outermost columns stay. Where there is none a value stands for less than any, so most decide. Points
  /// without a value get one only if `fill`, marked as filled.
  void (*median_row)(const GridValue* above, const GridValue* row, const GridValue* below, int width,
                     bool fill, GridValue* out);

  /// For the pixels of a row of the left image and of the `next` one, which of two neighbors they look
  /// like: those of `row` the ones at their left and right, those of `next` the ones in `row` and in `after`.
  /// As widen_row() and between_rows() understand it. Reads up to 32 pixels beside the rows, and writes up to
  /// 32 bytes beyond.
  void (*likeness_row)(const std::uint8_t* row, const std::uint8_t* next, const std::uint8_t* after,
                       int width, std::uint8_t* out);

  /// From the coarse grid's points to every column of the image: between two of them stands what
  /// between_rows() says. Writes one element after the row.
  void (*widen_row)(GridValue* row, int image_width, const std::uint8_t* likeness, GridValue* out);

  /// What stands between two values, column by column: their average if they are less than 1.5 px apart, else
  /// the one whose pixel looks more like the one between, the lower one if both do alike; the other one if
  /// one is not there. `likeness` is of the row of `a`.
  void (*between_rows)(const GridValue* a, const GridValue* b, int width, const std::uint8_t* likeness,
                       GridValue* out);

  /// From a row of values to disparities of the image, as match() writes them.
  void (*disparities_of_row)(const GridValue* row, int width, const Disparities&, std::int16_t* out);

  /// What a larger step of the disparity costs from each point to the one at its left: p2 less the step in
  /// gray levels, at least 0. `step` columns of the image to a point, 1 or 2. Reads the image, and
  /// writes, up to 32 elements beyond the last point; the first one means nothing.
  void (*step_limits)(const std::uint8_t* gray, int width, int step, int p2, std::uint8_t* limits);
};

/// The kernel of an instruction set that resolve_isa() has found.
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
