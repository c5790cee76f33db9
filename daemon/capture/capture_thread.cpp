// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/capture/capture_thread.h"

#include <chrono>
#include <utility>

namespace stereod {
namespace {

// Samples a grid of 32 × 24 pixels.
double mean_brightness_of(const LumaView& luma) noexcept {
  constexpr int kColumns = 32, kRows = 24;
  int sum = 0;
  for (int j = 0; j < kRows; ++j) {
    const std::uint8_t* row = luma.data + (2 * j + 1) * luma.size.height / (2 * kRows) * luma.row_stride;
    for (int i = 0; i < kColumns; ++i) {
      sum += row[(2 * i + 1) * luma.size.width / (2 * kColumns) * luma.pixel_stride];
    }
  }
  return static_cast<double>(sum) / (kColumns * kRows);
}

}  // namespace

CaptureThread::CaptureThread(Side side, FrameSource& source, PairQueue& pair_queue)
    : side_(side), source_(source), pair_queue_(pair_queue), thread_([this] { run(); }) {}

CaptureThread::~CaptureThread() { stop(); }

void CaptureThread::stop() noexcept {
  stopping_ = true;
  source_.stop();
  if (thread_.joinable()) thread_.join();
}

void CaptureThread::withdraw_waiting_frame() noexcept {
  if (!std::exchange(interrupted_, true)) pair_queue_.camera_interrupted(side_);
}

void CaptureThread::run() noexcept {
  constexpr std::chrono::milliseconds kTimeout{100};
  while (!stopping_) {
    FrameLease lease = source_.next(kTimeout);
    if (!lease) {
      const SourceState state = source_.state();
      if (state == SourceState::kFinished) break;
      if (state != SourceState::kStreaming) withdraw_waiting_frame();
      continue;
    }
    if (std::exchange(interrupted_, false)) pair_queue_.set_frame_time(side_, source_.frame_time_ns());
    mean_brightness_ = mean_brightness_of(lease.frame().luma);
    ++frames_;
    pair_queue_.add(side_, std::move(lease));
  }
  pair_queue_.camera_finished();
}

}  // namespace stereod
