// The interface between the simd search and its kernels, one for each instruction set.
#pragma once

#include <cstddef>
#include <cstdint>

namespace stereod::kernels {

/// Columns searched in one go, so that the costs of all their disparities stay in the first-level cache.
inline constexpr int kBlockColumns = 32;
/// Disparities whose running sums fit in the registers; more are searched in chunks of at most this many.
inline constexpr int kMaxChunk = 64;
inline constexpr int kMaxChunks = 4;

/// How the sums are calculated.
enum class Arithmetic {
  kPacked,  ///< |L−R| ≤ 126; 16-bit sums are cost·8 + number of the group of 8 disparities: the minimum tells
            ///< both
  kNarrow,  ///< |L−R| ≤ 126; 16-bit sums are costs, the winner is found by comparing with the minimum
  kRaw,     ///< |L−R| ≤ 255; 16-bit sums are costs
  kWide,    ///< |L−R| ≤ 255; 32-bit sums, for windows whose cost does not fit in 16 bits
};

/// What is fixed for a band. Column c of a row is image column min_disparity + c; in it the disparities
/// k < min(disparities, c − window + 2) can be searched for the window whose last column is c.
struct Shape {
  Arithmetic arithmetic;
  int width;  ///< of the image, px
  int min_disparity;
  int disparities;
  int window;
  int chunk;  ///< disparities in a chunk, a multiple of the kernel's granularity, ≤ kMaxChunk (kWide: any)
  int chunks;
  bool neighbours;  ///< RowWinners::before and after are wanted
  bool rival;       ///< RowWinners::rival is wanted
  int columns() const { return width - min_disparity; }
  int padded_disparities() const { return chunk * chunks; }
  /// Bytes of a right row as prepare_right_row() writes it.
  int right_row_bytes() const { return 2 * (width + padded_disparities()) + 64; }
  /// Bytes of one row of differences.
  std::ptrdiff_t difference_row_bytes() const {
    return static_cast<std::ptrdiff_t>(columns()) * padded_disparities();
  }
};

/// Where a search leaves its results; element 0 is the first column with an answer.
struct Winners {
  std::uint16_t* index;
  std::uint32_t* cost;
  std::uint32_t* before;
  std::uint32_t* after;
  std::uint32_t* rival;
};

/// The row that comes into the window, and the place of the one that leaves it.
struct AddedRow {
  const std::uint8_t* left;   ///< begins at image column min_disparity
  const std::uint8_t* right;  ///< as prepare_right_row() wrote it
  /// |L−R| of the row that leaves the window, zeros while it fills; becomes that of the row added. 64-byte
  /// aligned, [chunk][column][k].
  std::uint8_t* differences;
};

/// Memory of one search. 64-byte aligned.
struct Scratch {
  std::uint16_t* column_sums;  ///< [chunk][window + columns][k]; the first `window` columns stay zero
  std::uint16_t* block_sums;   ///< [kBlockColumns][padded_disparities], with 64 elements before and after
};

/// One instruction set's kernel. None of the functions needs alignment of image rows.
struct Kernel {
  int granularity;  ///< disparities in a byte vector; a chunk is a multiple of it

  /// Writes a right row backwards, so that growing disparity means growing address, and with the two halves
  /// of a chunk interleaved byte by byte, so that widening the bytes to 16 bits leaves disparities in order.
  void (*prepare_right_row)(const Shape&, const std::uint8_t* right, std::uint8_t* out);

  /// Adds a row to the column sums and subtracts the one that leaves.
  void (*add_row)(const Shape&, const AddedRow&, const Scratch&);

  /// The same, and finds the winner of every column that has an answer.
  void (*search_row)(const Shape&, const AddedRow&, const Scratch&, const Winners&);

  /// interpolate<float>() of core/match/interpolation.h; sums of absolute differences are small enough for
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

}  // namespace stereod::kernels
