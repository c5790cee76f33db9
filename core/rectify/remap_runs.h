// SPDX-License-Identifier: BSD-3-Clause
// Copies the pixels of a row from where the run table says.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

#include "core/rectify/run_table.h"

namespace stereod {

/// Copies one byte a pixel, from bytes kStride [1 or 2] apart. A copier has three functions: copy_run()
/// copies kRunPixels pixels, copy() copies `count` pixels, and clear() writes zeros.
template <int kStride>
struct PixelCopier {
  static constexpr int kBytes = 1;                     ///< of a pixel in the output
  static constexpr int kReach = kStride * kRunPixels;  ///< bytes that copy_run() reads
  static_assert(kStride == 1 || kStride == 2);

  void copy_run(const std::uint8_t* from, std::uint8_t* to) const {
    if constexpr (kStride == 1) {
      std::memcpy(to, from, kRunPixels);
    } else {
      // The lower bytes of 16-bit words, which compilers turn into a few vector instructions.
      static_assert(std::endian::native == std::endian::little);
      std::uint16_t words[kRunPixels];
      std::uint8_t bytes[kRunPixels];
      std::memcpy(words, from, sizeof(words));
      for (int i = 0; i < kRunPixels; ++i) bytes[i] = static_cast<std::uint8_t>(words[i]);
      std::memcpy(to, bytes, sizeof(bytes));
    }
  }
  void copy(const std::uint8_t* from, std::uint8_t* to, int count) const {
    for (int i = 0; i < count; ++i) to[i] = from[kStride * i];
  }
  void clear(std::uint8_t* to, int count) const { std::memset(to, 0, static_cast<std::size_t>(count)); }
  void clear(std::uint8_t* to) const { std::memset(to, 0, kRunPixels); }
};

/// Copies one byte a pixel, from bytes any distance apart.
struct StridedCopier {
  static constexpr int kBytes = 1;
  std::ptrdiff_t stride;

  void copy_run(const std::uint8_t* from, std::uint8_t* to) const { copy(from, to, kRunPixels); }
  void copy(const std::uint8_t* from, std::uint8_t* to, int count) const {
    for (std::ptrdiff_t i = 0; i < count; ++i) to[i] = from[stride * i];
  }
  void clear(std::uint8_t* to, int count) const { std::memset(to, 0, static_cast<std::size_t>(count)); }
  void clear(std::uint8_t* to) const { std::memset(to, 0, kRunPixels); }
};

/// Copies three bytes a pixel, from pixels `stride` [≥ 3] bytes apart. copy_run() requires a stride of 3.
struct ColorCopier {
  static constexpr int kBytes = 3;
  static constexpr int kReach = kBytes * kRunPixels;
  std::ptrdiff_t stride;

  void copy_run(const std::uint8_t* from, std::uint8_t* to) const { std::memcpy(to, from, kReach); }
  void copy(const std::uint8_t* from, std::uint8_t* to, int count) const {
    for (int i = 0; i < count; ++i, from += stride, to += kBytes) std::memcpy(to, from, kBytes);
  }
  void clear(std::uint8_t* to, int count) const {
    std::memset(to, 0, static_cast<std::size_t>(count) * kBytes);
  }
  void clear(std::uint8_t* to) const { std::memset(to, 0, kReach); }
};

/// Copies the four neighbors of points between pixels, each into a plane of its own: upper left, upper right,
/// lower left, lower right.
template <typename Copier>
struct BilinearTaps {
  static constexpr int kBytes = Copier::kBytes;
  Copier copier;
  std::ptrdiff_t right, below;  ///< [bytes] from a pixel to its right and to its lower neighbor
  std::ptrdiff_t plane;         ///< [bytes] from plane to plane

  void copy_run(const std::uint8_t* from, std::uint8_t* to) const {
    copier.copy_run(from, to);
    copier.copy_run(from + right, to + plane);
    copier.copy_run(from + below, to + 2 * plane);
    copier.copy_run(from + below + right, to + 3 * plane);
  }
  void copy(const std::uint8_t* from, std::uint8_t* to, int count) const {
    copier.copy(from, to, count);
    copier.copy(from + right, to + plane, count);
    copier.copy(from + below, to + 2 * plane, count);
    copier.copy(from + below + right, to + 3 * plane, count);
  }
  void clear(std::uint8_t* to, int count) const {
    for (int i = 0; i < 4; ++i) copier.clear(to + i * plane, count);
  }
  void clear(std::uint8_t* to) const {
    for (int i = 0; i < 4; ++i) copier.clear(to + i * plane);
  }
};

/// Copies a row segment by segment. Rows of whole runs write up to kRunPixels − 1 pixels past the end of a
/// segment.
template <typename Copier>
class RowCopier {
 public:
  RowCopier(const RunTable& table, const RunTable::Row& row, const std::uint8_t* source, const Copier& copier)
      : source_(source), copier_(copier), kind_(row.kind) {
    if (kind_ == RunTable::Kind::kOffsets) {
      offset_ = table.offsets(row);
    } else {
      run_ = table.runs(row);
    }
  }

  /// Copies the segment [@p first, @p end) to @p to. Segments follow one another.
  void next(int first, int end, std::uint8_t* to) {
    std::uint8_t* const base = to - static_cast<std::ptrdiff_t>(first) * Copier::kBytes;
    switch (kind_) {
      case RunTable::Kind::kWholeRuns:
        for (; run_->first < end; ++run_) copier_.copy_run(source_ + run_->source, position(base));
        break;
      case RunTable::Kind::kWholeRunsOrNone:
        for (; run_->first < end; ++run_) {
          if (run_->source < 0) {
            copier_.clear(position(base));
          } else {
            copier_.copy_run(source_ + run_->source, position(base));
          }
        }
        break;
      case RunTable::Kind::kExactRuns:
        for (; run_->first < end; ++run_) copy_or_clear(run_->source, position(base), run_->count);
        break;
      case RunTable::Kind::kOffsets:
        for (int x = first; x < end; ++x, to += Copier::kBytes) copy_or_clear(*offset_++, to, 1);
        break;
    }
  }

 private:
  std::uint8_t* position(std::uint8_t* base) const {
    return base + static_cast<std::ptrdiff_t>(run_->first) * Copier::kBytes;
  }
  void copy_or_clear(std::int32_t from, std::uint8_t* to, int count) const {
    if (from < 0) {
      copier_.clear(to, count);
    } else {
      copier_.copy(source_ + from, to, count);
    }
  }

  const std::uint8_t* source_;
  Copier copier_;
  RunTable::Kind kind_;
  const Run* run_ = nullptr;
  const std::int32_t* offset_ = nullptr;
};

}  // namespace stereod
