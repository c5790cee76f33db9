// SPDX-License-Identifier: BSD-3-Clause
// Images for frames that are decoded, lent one by one.
#pragma once

#include <array>
#include <cstddef>
#include <mutex>
#include <vector>

#include "core/base/image.h"

namespace stereod::v4l2 {

/// A fixed number of 8-bit images of one size. find_free(), image() and lend() belong to the
/// camera's thread, give_back() to any thread.
class ImagePool {
 public:
  /// The number of frames of one camera that the pipeline may hold: waiting, in a pair, being matched.
  static constexpr int kImages = 5;

  /// @throws std::bad_alloc
  explicit ImagePool(Size size) {
    for (int i = 0; i < kImages; ++i) images_.emplace_back(size);
  }

  /// Returns the index of an image that is not on loan, -1 if there is none. The image counts as on loan
  /// after lend().
  int find_free() const noexcept {
    const std::lock_guard lock(mutex_);
    for (int i = 0; i < kImages; ++i) {
      if (!on_loan_[static_cast<std::size_t>(i)]) return i;
    }
    return -1;
  }
  GrayImage& image(int index) noexcept { return images_[static_cast<std::size_t>(index)]; }

  void lend(int index) noexcept { set_on_loan(index, true); }
  void give_back(int index) noexcept { set_on_loan(index, false); }

 private:
  void set_on_loan(int index, bool on_loan) noexcept {
    const std::lock_guard lock(mutex_);
    on_loan_[static_cast<std::size_t>(index)] = on_loan;
  }

  std::vector<GrayImage> images_;
  mutable std::mutex mutex_;
  std::array<bool, kImages> on_loan_{};
};

}  // namespace stereod::v4l2
