// The interface between the simd search and its kernels, one for each instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

namespace stereod::kernels {

/// Columns searched in one go, so that the sums of all their disparities stay in the first-level cache.
inline constexpr int kBlockColumns = 64;
/// Elements between two columns of Scratch::block_sums: 32 bytes, so that columns stay aligned.
inline constexpr int kBlockGap = 16;
/// Disparities whose running sums fit in the registers; more are searched in chunks of at most this many.
inline constexpr int kMaxChunk = 64;
inline constexpr int kMaxChunks = 4;
/// Bytes of the longest vector of any kernel.
inline constexpr int kMaxVector = 32;
/// Bytes after a row of image or prepared pixels that a kernel may read.
inline constexpr int kRowMargin = 64;

/// How the sums are calculated. A group is 8 disparities.
enum class Arithmetic {
  kPacked,  ///< |L−R| ≤ 126; 16-bit sums are cost·8 + number of the group in the chunk: the minimum tells
            ///< both
  kPackedHalves,  ///< the same with cost·4 + number of the group in its half of the chunk, a minimum for each
                  ///< half
  kRaw,   ///< |L−R| ≤ 255; 16-bit sums are costs, the winner is found by comparing with the minimum
  kWide,  ///< |L−R| ≤ 255; 32-bit sums, for windows whose cost does not fit in 16 bits
};

/// What is fixed for a band. Column c of a row is image column min_disparity + c; in it the disparities
/// k < min(disparities, c − window + 2) can be searched for the window whose last column is c.
struct Shape {
  Arithmetic arithmetic;
  int width;  ///< of the image, px
  int min_disparity;
  int disparities;
  int window;
  int chunk;  ///< disparities in a chunk: what Kernel::chunk_for says
  int chunks;
  bool recompute;        ///< differences that leave the window are calculated again, not kept
  bool neighbors;        ///< Winners::before and after are wanted
  int uniqueness_ratio;  ///< %; 0: Winners::ambiguous is not wanted
  int columns() const { return width - min_disparity; }
  int padded_disparities() const { return chunk * chunks; }
  /// From a column of Scratch::block_sums to the next. What lies between two is written over at will.
  int block_step() const { return padded_disparities() + kBlockGap; }
  /// The first disparity of a chunk. The last of several ends with the last disparity, and so has some in
  /// common with the one before it. A single one may be wider than the search; where its disparities lie then
  /// is said in column_sums.h.
  int first_of(int of_chunk) const {
    return of_chunk + 1 < chunks || chunks == 1 ? of_chunk * chunk : disparities - chunk;
  }
  /// Bytes of a right row as Kernel::prepare_right_row writes it.
  int right_row_bytes() const { return 2 * (width + padded_disparities()) + kRowMargin; }
};

/// The columns [first, end) of a row that are done in one go, with column sums of their own: a whole row, or
/// a strip whose column sums stay in the first-level cache from row to row. Its windows lie within it.
struct Strip {
  int first, end;
  int columns() const { return end - first; }
};

/// Where a search leaves its results; element 0 is the first column with an answer. After the
/// strip's last one fewer than kBlockColumns elements are written over, so strips go from left to right.
struct Winners {
  std::uint16_t* index;
  std::uint32_t* cost;
  std::uint32_t* before;
  std::uint32_t* after;
  std::uint8_t* ambiguous;
};

/// A row of both images as the kernels take it.
struct InputRow {
  const std::uint8_t* left;   ///< begins at image column min_disparity
  const std::uint8_t* right;  ///< as Kernel::prepare_right_row wrote it
};

/// The row that comes into the window, and the one that leaves it.
struct RowChange {
  InputRow added;
  InputRow removed;  ///< only with Shape::recompute: the row that leaves, zeros while the window fills
  /// Only without: where |L−R| of the row added goes, and those of the row that leaves, zeros while the
  /// window fills. 64-byte aligned, [chunk][column of the strip][k].
  std::uint8_t* differences;
  const std::uint8_t* removed_differences;
};

/// Memory of one strip. 64-byte aligned.
struct Scratch {
  std::uint16_t* column_sums;  ///< [chunk][window + column of the strip][k]; the first `window` stay zero
  /// [kBlockColumns][block_step], by k, with 64 elements before and after. Beyond the last disparity
  /// they hold, from the beginning, what is larger than any sum: Kernel::no_sum.
  std::uint16_t* block_sums;
};

/// One instruction set's kernel. None of the functions needs alignment of image rows.
struct Kernel {
  /// How many disparities a chunk has that holds at least `disparities` ≤ kMaxChunk of them.
  int (*chunk_for)(int disparities);

  /// xsobel_row() of core/match/block/prefilter.h.
  void (*xsobel_row)(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int width,
                     int cap, std::uint8_t* out);

  /// Writes a right row backwards, so that growing disparity means growing address, in the order in which
  /// the kernel's widening of bytes to 16 bits leaves disparities in order.
  void (*prepare_right_row)(const Shape&, const std::uint8_t* right, std::uint8_t* out);

  /// What stands in Scratch::block_sums where there is no sum.
  std::uint16_t no_sum;

  /// Adds a row to the column sums of a strip and subtracts the one that leaves.
  void (*add_row)(const Shape&, const Strip&, const RowChange&, const Scratch&);

  /// The same, and finds the winner of every column that has an answer.
  void (*search_row)(const Shape&, const Strip&, const RowChange&, const Scratch&, const Winners&);

  /// interpolate<float>() of core/match/block/interpolation.h; sums of absolute differences are small enough for
  /// it.
  void (*interpolate)(const std::uint16_t* index, const std::uint32_t* cost, const std::uint32_t* before,
                      const std::uint32_t* after, int count, int min_disparity, int disparities,
                      std::int16_t* out);
};

extern const Kernel kScalarKernel;
#if defined(__x86_64__) || defined(__i386__)
extern const Kernel kSsse3Kernel;
extern const Kernel kSse41Kernel;
extern const Kernel kAvx2Kernel;
#endif
#if defined(__aarch64__) || defined(__ARM_NEON)
extern const Kernel kNeonKernel;
#endif

}  // namespace stereod::kernels
