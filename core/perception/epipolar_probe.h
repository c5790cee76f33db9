// SPDX-License-Identifier: BSD-3-Clause
// Measures the epipolar error on a few points of each frame.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/aligned_buffer.h"
#include "core/base/image.h"
#include "core/base/validity_mask.h"
#include "core/perception/epipolar_error.h"
#include "core/rectify/rectify_map.h"

namespace stereod {

/// The frame of one camera and how it is rectified. Borrows all three.
struct ProbedFrame {
  const RectifyMap& map;
  const ValidityMask& mask;
  const std::uint8_t* source;
};

/// Rectifies one strip of rows of each frame, at a different height each time, and in each third of it
/// searches the best textured patch of the left image in the right one: along the row as the matcher does,
/// and also some rows up and down. A unique match is refined to fractions of a pixel (Lucas and Kanade 1981,
/// in both directions, with brightness and contrast normalized). Allocates nothing after construction.
class EpipolarProbe {
 public:
  static constexpr int kPatches = 3;

  /// Rows that are searched up and down. kNear: 2, enough to confirm a good calibration and several times
  /// cheaper. kFar: 1/20 of the height, 4…24.
  enum class Reach { kNear, kFar };

  /// Allocates memory for images of size @p image and disparities [@p min_disparity, @p min_disparity + @p
  /// disparities).
  EpipolarProbe(Size image, int min_disparity, int disparities);

  /// The result for the patches of a frame.
  struct Result {
    int found = 0;   ///< matches written
    int absent = 0;  ///< textured patches without a similar place within reach
  };

  /// Probes one frame and writes the matches to the front of @p matches. Finds nothing in images of fewer
  /// than 48 columns or 24 rows.
  Result probe(const ProbedFrame& left, const ProbedFrame& right, Reach reach,
               std::span<EpipolarMatch, kPatches> matches) noexcept;

 private:
  static constexpr int kColumns = 16, kRows = 8;  // of a patch
  static constexpr int kUsedRows = kRows / 2;     // that the search compares
  static constexpr int kNear = 2;                 // rows up and down

  // The upper left pixel of a patch in the right strip.
  struct Position {
    int x, y;
  };
  // Every second row of a patch of the left strip, with the gray values of the right one.
  struct Patch {
    std::uint8_t gray[kUsedRows][kColumns];
    std::uint32_t contrast;  // sum of |difference| from the mean
  };
  // The inner pixels of a patch less their mean, their gradients, and sums of squares and products of these.
  static constexpr int kInner = (kColumns - 2) * (kRows - 2);
  struct Gradients {
    float value[kInner], slope_x[kInner], slope_y[kInner];
    float xx, xy, yy;
    float deviation;  // sum of value²
  };
  // Gray values of a strip.
  struct GrayStats {
    float mean, deviation;
  };

  void smooth_rows(const ProbedFrame& frame, RowRange rows, std::uint8_t* out) noexcept;
  static GrayStats gray_stats(const std::uint8_t* rows, int width, std::ptrdiff_t stride) noexcept;
  void measure_texture() noexcept;
  int best_column(int first, int end) const noexcept;
  Patch adjusted_patch(int x, const GrayStats& from, const GrayStats& to) const noexcept;
  std::uint32_t minimum_cost(const Patch& patch, int first, int positions, Position& best) noexcept;
  std::uint32_t rival_cost(int first, int positions, const Position& best) const noexcept;
  bool search(int x, const GrayStats& from, const GrayStats& to, Position& best, bool& absent) noexcept;
  Gradients gradients_at(int x) const noexcept;
  bool sample_right(const Position& position, float across, float down, float* samples) const noexcept;
  bool refine(int x, const Position& position, float& across, float& down) const noexcept;

  const std::uint8_t* left_row(int row) const { return left_.data() + row * stride_; }
  const std::uint8_t* right_row(int row) const { return right_.data() + row * stride_; }

  Size image_;
  int min_disparity_, disparities_;
  int far_;                                     // rows that kFar searches up and down
  int reach_;                                   // rows that the current probe searches up and down
  std::ptrdiff_t stride_;                       // of both strips
  std::uint32_t turn_ = 0;                      // number of probes
  AlignedBuffer<std::uint8_t> rectified_;       // three rows
  AlignedBuffer<std::uint16_t> sums_;           // a row
  AlignedBuffer<std::uint8_t> left_, right_;    // kRows, and kRows + 2·far_ rows
  AlignedBuffer<std::uint16_t> across_, down_;  // sums of |differences| over a column of the left strip
  AlignedBuffer<std::uint32_t> costs_;          // [2·far_ + 1][disparities_]
};

}  // namespace stereod
