// Are the rows of a rectified pair still side by side? Looked at on a few points of a frame.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/aligned_buffer.h"
#include "core/base/image.h"
#include "core/base/validity_mask.h"
#include "core/perception/epipolar_error.h"
#include "core/rectify/rectify_map.h"

namespace stereod {

/// One camera's frame and how it is rectified; borrowed.
struct ProbedFrame {
  const RectifyMap& map;
  const ValidityMask& mask;
  const std::uint8_t* source;
};

/// Takes one strip of rows of each frame, another one each time, rectifies it, and in each third of it
/// searches the best textured patch of the left image in the right one: along the row as the matcher does,
/// but also some rows up and down. What is found, and nowhere else nearly as well, is refined to fractions of
/// a pixel (Lucas and Kanade 1981, for both directions, with brightness and contrast taken out). After
/// construction it allocates nothing.
class EpipolarProbe {
 public:
  static constexpr int kPatches = 3;

  /// How many rows up and down it searches: two, enough to see that all is well and several times cheaper, or
  /// a twentieth of the height (4 to 24).
  enum class Reach { kNear, kFar };

  EpipolarProbe(Size image, int min_disparity, int disparities);

  /// What became of the patches of a frame.
  struct Result {
    int found = 0;   ///< as many matches were written
    int absent = 0;  ///< have texture, but nothing within reach is like them
  };

  /// Writes what it found to the front of `matches`. Nothing is ever found in images too small for it: less
  /// than 48 columns or 24 rows.
  Result probe(const ProbedFrame& left, const ProbedFrame& right, Reach reach,
               std::span<EpipolarMatch, kPatches> matches) noexcept;

 private:
  static constexpr int kColumns = 16, kRows = 8;  // of a patch
  static constexpr int kNear = 2;                 // rows up and down

  struct Place {
    int x, y;  // of a patch's upper left pixel
  };
  // How brightness is distributed in a strip.
  struct Tone {
    float mean, deviation;
  };

  void smooth_rows(const ProbedFrame& frame, RowRange rows, std::uint8_t* out) noexcept;
  static Tone tone_of(const std::uint8_t* rows, int width, std::ptrdiff_t stride) noexcept;
  void measure_texture() noexcept;
  int best_column(int first, int end) const noexcept;
  bool search(int x, const Tone& from, const Tone& to, Place& best, bool& absent) noexcept;
  bool refine(int x, const Place& place, float& across, float& down) const noexcept;

  const std::uint8_t* left_row(int row) const { return left_.data() + row * stride_; }
  const std::uint8_t* right_row(int row) const { return right_.data() + row * stride_; }

  Size image_;
  int min_disparity_, disparities_;
  int far_;                                     // rows up and down
  int reach_;                                   // the same, of this time
  std::ptrdiff_t stride_;                       // of both strips
  std::uint32_t turn_ = 0;                      // how often it was asked
  AlignedBuffer<std::uint8_t> rectified_;       // three rows
  AlignedBuffer<std::uint16_t> sums_;           // a row
  AlignedBuffer<std::uint8_t> left_, right_;    // kRows, and kRows + 2·far_ rows
  AlignedBuffer<std::uint16_t> across_, down_;  // sums over a column of the left strip of |differences|
  AlignedBuffer<std::uint32_t> costs_;          // [2·far_ + 1][disparities_]
};

}  // namespace stereod
