// SPDX-License-Identifier: BSD-3-Clause
// A rendered scene as two cameras.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <vector>

#include "core/geometry/calibration.h"
#include "daemon/capture/frame_clock.h"
#include "daemon/capture/frame_source.h"
#include "daemon/capture/synthetic/synthetic_board.h"

namespace stereod {

struct SyntheticOptions {
  Size size{640, 480};  ///< [px, ≥ 64×48]
  double fps = 30;      ///< [Hz, 0…1000]; 0 = as fast as frames are given back
  int frames = 24;      ///< [≥ 1] length of the loop, rendered beforehand; ignored with a board
  bool board = false;   ///< show a calibration chessboard in an empty room instead of boxes
  std::chrono::microseconds skew{0};  ///< how much later the right camera exposes
};

/// One of the two cameras. Lends the rendered images themselves, which are read-only. Frame n shows entry n
/// modulo the loop's length; FrameClock decides when it is due.
class SyntheticSource final : public FrameSource, private BufferOwner {
 public:
  /// State that the two cameras share.
  struct Loop {
    std::vector<GrayImage> images[2];  // of the left and of the right camera
    std::vector<std::size_t> order;    // for each frame of the loop, the index of its image
    FrameClock clock;
  };

  /// @p camera: 0 = left, 1 = right.
  SyntheticSource(std::shared_ptr<Loop> loop, int camera);

  Size frame_size() const override { return images_.front().size(); }
  FrameLease next(std::chrono::milliseconds timeout) noexcept override;
  SourceState state() const noexcept override;
  void stop() noexcept override { loop_->clock.stop(camera_); }

 private:
  void give_back(int buffer) noexcept override;

  std::shared_ptr<Loop> loop_;
  int camera_;
  const std::vector<GrayImage>& images_;
  std::atomic<bool> streaming_{false};
};

/// The board of SyntheticOptions::board. It is out of sight at first, then stays for two seconds (fps 0: four
/// frames) at each of kBoardPlaces places.
inline constexpr BoardShape kPracticeBoard{9, 6, 0.025};
inline constexpr int kBoardPlaces = 18;

/// Frames n of both cameras have the same number and capture times exactly `skew` apart.
struct SyntheticPair {
  std::unique_ptr<SyntheticSource> left, right;
  Calibration calibration;
};

/// Renders the loop on up to four threads. @throws std::invalid_argument if an option is out of range.
SyntheticPair make_synthetic_pair(const SyntheticOptions& options);

}  // namespace stereod
