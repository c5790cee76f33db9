// Moving the pixels of a row's stretch by the table.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

#include "core/rectify/run_table.h"

namespace stereod {

/// One byte a pixel from bytes kStride apart. A mover says how a run of pixels gets to its place: `whole`
/// moves kRunPixels of them whatever the run's length, `exact` so many, `nothing` writes zeros.
template <int kStride>
struct GrayMover {
  static constexpr int kBytes = 1;                     ///< that a pixel takes where it goes
  static constexpr int kReach = kStride * kRunPixels;  ///< bytes that `whole` reads
  static_assert(kStride == 1 || kStride == 2);

  void whole(const std::uint8_t* from, std::uint8_t* to) const {
    if constexpr (kStride == 1) {
      std::memcpy(to, from, kRunPixels);
    } else {
      // The lower bytes of 16-bit words: compilers know a few vector instructions for that.
      static_assert(std::endian::native == std::endian::little);
      std::uint16_t words[kRunPixels];
      std::uint8_t bytes[kRunPixels];
      std::memcpy(words, from, sizeof(words));
      for (int i = 0; i < kRunPixels; ++i) bytes[i] = static_cast<std::uint8_t>(words[i]);
      std::memcpy(to, bytes, sizeof(bytes));
    }
  }
  void exact(const std::uint8_t* from, std::uint8_t* to, int count) const {
    for (int i = 0; i < count; ++i) to[i] = from[kStride * i];
  }
  void nothing(std::uint8_t* to, int count) const { std::memset(to, 0, static_cast<std::size_t>(count)); }
  void nothing(std::uint8_t* to) const { std::memset(to, 0, kRunPixels); }
};

/// The same for bytes any distance apart.
struct SparseMover {
  static constexpr int kBytes = 1;
  std::ptrdiff_t stride;

  void whole(const std::uint8_t* from, std::uint8_t* to) const { exact(from, to, kRunPixels); }
  void exact(const std::uint8_t* from, std::uint8_t* to, int count) const {
    for (std::ptrdiff_t i = 0; i < count; ++i) to[i] = from[stride * i];
  }
  void nothing(std::uint8_t* to, int count) const { std::memset(to, 0, static_cast<std::size_t>(count)); }
  void nothing(std::uint8_t* to) const { std::memset(to, 0, kRunPixels); }
};

/// Three bytes a pixel, from pixels `stride` ≥ 3 bytes apart; whole runs only of pixels that touch.
struct ColorMover {
  static constexpr int kBytes = 3;
  static constexpr int kReach = kBytes * kRunPixels;
  std::ptrdiff_t stride;

  void whole(const std::uint8_t* from, std::uint8_t* to) const { std::memcpy(to, from, kReach); }
  void exact(const std::uint8_t* from, std::uint8_t* to, int count) const {
    for (int i = 0; i < count; ++i, from += stride, to += kBytes) std::memcpy(to, from, kBytes);
  }
  void nothing(std::uint8_t* to, int count) const {
    std::memset(to, 0, static_cast<std::size_t>(count) * kBytes);
  }
  void nothing(std::uint8_t* to) const { std::memset(to, 0, kReach); }
};

/// The four pixels around a point, each into a plane of its own: itself, the one to the right, the one below,
/// and below that one's right.
template <typename Mover>
struct FourMover {
  static constexpr int kBytes = Mover::kBytes;
  Mover one;
  std::ptrdiff_t right, below;  ///< how many bytes further they lie
  std::ptrdiff_t plane;         ///< from plane to plane

  void whole(const std::uint8_t* from, std::uint8_t* to) const {
    one.whole(from, to);
    one.whole(from + right, to + plane);
    one.whole(from + below, to + 2 * plane);
    one.whole(from + below + right, to + 3 * plane);
  }
  void exact(const std::uint8_t* from, std::uint8_t* to, int count) const {
    one.exact(from, to, count);
    one.exact(from + right, to + plane, count);
    one.exact(from + below, to + 2 * plane, count);
    one.exact(from + below + right, to + 3 * plane, count);
  }
  void nothing(std::uint8_t* to, int count) const {
    for (int i = 0; i < 4; ++i) one.nothing(to + i * plane, count);
  }
  void nothing(std::uint8_t* to) const {
    for (int i = 0; i < 4; ++i) one.nothing(to + i * plane);
  }
};

/// Goes along a row, stretch by stretch. Rows of whole runs write up to kRunPixels − 1 pixels beyond a
/// stretch.
template <typename Mover>
class RowMoves {
 public:
  RowMoves(const RunTable& table, const RunTable::Row& row, const std::uint8_t* source, const Mover& mover)
      : source_(source), mover_(mover), kind_(row.kind) {
    if (kind_ == RunTable::Kind::kOffsets) {
      offset_ = table.offsets(row);
    } else {
      run_ = table.runs(row);
    }
  }

  /// Moves the stretch [first, end) to `to`.
  void next(int first, int end, std::uint8_t* to) {
    std::uint8_t* const base = to - static_cast<std::ptrdiff_t>(first) * Mover::kBytes;
    switch (kind_) {
      case RunTable::Kind::kWholeRuns:
        for (; run_->first < end; ++run_) mover_.whole(source_ + run_->source, place(base));
        break;
      case RunTable::Kind::kWholeRunsOrNone:
        for (; run_->first < end; ++run_) {
          if (run_->source < 0) {
            mover_.nothing(place(base));
          } else {
            mover_.whole(source_ + run_->source, place(base));
          }
        }
        break;
      case RunTable::Kind::kExactRuns:
        for (; run_->first < end; ++run_) pixels(run_->source, place(base), run_->count);
        break;
      case RunTable::Kind::kOffsets:
        for (int x = first; x < end; ++x, to += Mover::kBytes) pixels(*offset_++, to, 1);
        break;
    }
  }

 private:
  std::uint8_t* place(std::uint8_t* base) const {
    return base + static_cast<std::ptrdiff_t>(run_->first) * Mover::kBytes;
  }
  void pixels(std::int32_t from, std::uint8_t* to, int count) const {
    if (from < 0) {
      mover_.nothing(to, count);
    } else {
      mover_.exact(source_ + from, to, count);
    }
  }

  const std::uint8_t* source_;
  Mover mover_;
  RunTable::Kind kind_;
  const Run* run_ = nullptr;
  const std::int32_t* offset_ = nullptr;
};

}  // namespace stereod
