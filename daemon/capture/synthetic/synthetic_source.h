// The synthetic scene as a pair of cameras.
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
  Size size{640, 480};  ///< from 64×48 up
  double fps = 30;      ///< 0…1000; 0 is as fast as frames are given back
  int frames = 24;      ///< rendered beforehand and shown over and over, ≥ 1; not with a board
  bool board = false;   ///< a chessboard to calibrate with, in an empty room, instead of boxes
  std::chrono::microseconds skew{0};  ///< how much later than the left camera the right one exposes
};

/// One of the two cameras. Lends the rendered frames themselves, which nobody may write to; number n is frame
/// n modulo the length of the loop, and FrameClock says when it comes.
class SyntheticSource final : public FrameSource, private BufferOwner {
 public:
  /// What the two cameras share.
  struct Loop {
    std::vector<GrayImage> pictures[2];  // of the left camera, of the right one
    std::vector<std::size_t> order;      // which of them each frame of the loop shows
    FrameClock clock;
  };

  /// `camera`: 0 is the left one, 1 the right one.
  SyntheticSource(std::shared_ptr<Loop> loop, int camera);

  Size frame_size() const override { return pictures_.front().size(); }
  FrameLease next(std::chrono::milliseconds timeout) noexcept override;
  SourceState state() const noexcept override;
  void stop() noexcept override { loop_->clock.stop(camera_); }

 private:
  void give_back(int buffer) noexcept override;

  std::shared_ptr<Loop> loop_;
  int camera_;
  const std::vector<GrayImage>& pictures_;
  std::atomic<bool> streaming_{false};
};

/// The board that `board` shows. It is out of sight at first, then is held for two seconds (at fps 0: four
/// frames) in each of kBoardPlaces places, as a person should hold it.
inline constexpr BoardShape kPracticeBoard{9, 6, 0.025};
inline constexpr int kBoardPlaces = 18;

/// Frame n of both is of one moment: the same number, capture times exactly `skew` apart.
struct SyntheticPair {
  std::unique_ptr<SyntheticSource> left, right;
  Calibration calibration;
};

/// Renders the loop, on up to four threads. Throws std::invalid_argument.
SyntheticPair make_synthetic_pair(const SyntheticOptions& options);

}  // namespace stereod
