// SPDX-License-Identifier: BSD-3-Clause
// The interface between the simd search and its kernels, one for each instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

namespace stereod::kernels {

/// Columns whose sums of all disparities stay in the first-level cache while their winners are found.
inline constexpr int kBlockColumns = 64;
/// Unused elements between two columns of Scratch::block_sums: 32 bytes, so that columns stay aligned.
inline constexpr int kBlockGap = 16;
/// Maximum number of disparities whose running sums fit in the registers. More are searched in chunks.
inline constexpr int kMaxChunk = 64;
inline constexpr int kMaxChunks = 4;
/// Bytes of the widest vector of any kernel.
inline constexpr int kMaxVector = 32;
/// Bytes past the end of a row of an image or of prepared pixels that a kernel may read.
inline constexpr int kRowMargin = 64;

/// How sums are computed. A group is 8 disparities.
enum class Arithmetic {
  /// |L−R| ≤ 126. 16-bit sums are cost·8 + number of the group in its chunk: the minimum tells both.
  kPacked,
  /// |L−R| ≤ 126. 16-bit sums are cost·4 + number of the group in its half of the chunk; one minimum a half.
  kPackedHalves,
  /// |L−R| ≤ 255. 16-bit sums are costs; the winner is found by comparing with the minimum.
  kRaw,
  /// |L−R| ≤ 255. 32-bit sums, for windows whose cost exceeds 16 bits.
  kWide,
};

/// What stays the same for all rows. Column c of a row is image column min_disparity + c. For the window
/// whose last column is c, the disparities k < min(disparities, c − window + 2) can be searched.
struct SearchParams {
  Arithmetic arithmetic;
  int width;  ///< [px] of the image
  int min_disparity;
  int disparities;
  int window;
  int chunk;             ///< disparities in a chunk, a result of Kernel::chunk_for
  int chunks;            ///< 1…kMaxChunks
  bool recompute;        ///< differences that leave the window are computed again instead of stored
  bool neighbors;        ///< Winners::before and after are wanted
  int uniqueness_ratio;  ///< [%] 0: Winners::ambiguous is not wanted

  int columns() const { return width - min_disparity; }
  int padded_disparities() const { return chunk * chunks; }
  /// Returns the elements from one column of Scratch::block_sums to the next. Those between may be
  /// overwritten.
  int block_step() const { return padded_disparities() + kBlockGap; }
  /// Returns the first disparity of chunk @p index. The last of several chunks ends with the last disparity,
  /// so that it overlaps the one before. A single chunk may have more lanes than disparities: see
  /// column_sums.h.
  int first_of(int index) const {
    return index + 1 < chunks || chunks == 1 ? index * chunk : disparities - chunk;
  }
  /// Returns the bytes of a right row as Kernel::prepare_right_row writes it.
  int right_row_bytes() const { return 2 * (width + padded_disparities()) + kRowMargin; }
};

/// The columns [first, end) of a row that are searched together, with column sums of their own: the whole
/// row, or so few that the column sums stay in the first-level cache from row to row. Windows lie within a
/// tile.
struct ColumnTile {
  int first, end;
  int columns() const { return end - first; }
};

/// Receives the result of a search; element 0 is the first column that can have a disparity. Up to
/// kBlockColumns − 1 elements past the last one of the tile are overwritten, so tiles go from left to right.
struct Winners {
  std::uint16_t* index;
  std::uint32_t* cost;
  std::uint32_t* before;
  std::uint32_t* after;
  std::uint8_t* ambiguous;
};

/// A row of both images.
struct InputRow {
  const std::uint8_t* left;   ///< from image column min_disparity on
  const std::uint8_t* right;  ///< as Kernel::prepare_right_row writes it
};

/// The row that enters the window and the one that leaves it.
struct RowChange {
  InputRow added;
  /// Only with SearchParams::recompute: the row that leaves; zeros while the window fills.
  InputRow removed;
  /// Only without: receives |L−R| of the row added, 64-byte aligned, [chunk][column of the tile][k].
  std::uint8_t* differences;
  /// Only without: |L−R| of the row that leaves, in the same order; zeros while the window fills.
  const std::uint8_t* removed_differences;
};

/// The memory of one tile, 64-byte aligned.
struct Scratch {
  std::uint16_t*
      column_sums;  ///< [chunk][window + column of the tile][k]; the first `window` columns stay zero
  /// [kBlockColumns][block_step], by k, with 64 elements before and after. Elements without a sum hold
  /// Kernel::no_sum, which exceeds any sum.
  std::uint16_t* block_sums;
};

/// The functions of one instruction set. Image rows may have any alignment.
struct Kernel {
  /// Returns the size of a chunk that holds at least @p disparities [1…kMaxChunk] disparities.
  int (*chunk_for)(int disparities);

  /// xsobel_row() of core/match/block/prefilter.h.
  void (*xsobel_row)(const std::uint8_t* above, const std::uint8_t* row, const std::uint8_t* below, int width,
                     int cap, std::uint8_t* out);

  /// Writes a right row in reverse order, so that growing disparity means growing address, with its bytes
  /// interleaved as the kernel's widening from 8 to 16 bits requires.
  void (*prepare_right_row)(const SearchParams&, const std::uint8_t* right, std::uint8_t* out);

  /// The value of Scratch::block_sums where there is no sum.
  std::uint16_t no_sum;

  /// Adds a row to the column sums of a tile and subtracts the one that leaves.
  void (*add_row)(const SearchParams&, const ColumnTile&, const RowChange&, const Scratch&);

  /// Does the same as add_row and finds the winner of each column.
  void (*search_row)(const SearchParams&, const ColumnTile&, const RowChange&, const Scratch&,
                     const Winners&);

  /// interpolate<float>() of core/match/block/interpolation.h, which is exact for sums of absolute
  /// differences.
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
