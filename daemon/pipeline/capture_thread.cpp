#include "daemon/pipeline/capture_thread.h"

#include <chrono>
#include <utility>

namespace stereod {

CaptureThread::CaptureThread(Side side, FrameSource& source, PairingDesk& desk)
    : side_(side), source_(source), desk_(desk), thread_([this] { run(); }) {}

CaptureThread::~CaptureThread() { stop(); }

void CaptureThread::stop() noexcept {
  stopping_ = true;
  source_.stop();
  if (thread_.joinable()) thread_.join();
}

void CaptureThread::run() noexcept {
  constexpr std::chrono::milliseconds kTimeout{100};
  std::uint32_t expected = 0;
  while (!stopping_) {
    FrameLease lease = source_.next(kTimeout);
    if (!lease) {
      if (source_.state() == SourceState::kFinished) break;
      continue;
    }
    const std::uint32_t sequence = lease.frame().sequence;
    // A sequence that goes back is a camera that began anew, not a loss.
    if (frames_ > 0 && sequence > expected) sequence_gaps_ += sequence - expected;
    expected = sequence + 1;
    ++frames_;
    desk_.add(side_, std::move(lease));
  }
  desk_.camera_finished();
}

}  // namespace stereod
