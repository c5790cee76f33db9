// A webcam as a frame source that never gives up.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "daemon/capture/frame_source.h"
#include "daemon/capture/v4l2/camera_stream.h"
#include "daemon/capture/v4l2/exposure_sync.h"
#include "daemon/capture/v4l2/v4l2_pair_state.h"
#include "daemon/config/config.h"

namespace stereod {

enum class LogLevel { kInfo, kWarning };
/// Takes a sentence for the log. Called when a camera's state changes, never for a frame.
using CameraLog = std::function<void(LogLevel level, const std::string& sentence)>;

/// Its thread goes round in next(): a camera that is not there is waited for, one that is there is set up,
/// one that streams is read, and one that fails is closed and set up again after a pause. None of that needs
/// the other camera, and nothing of it ends. Closing waits until no frame is on loan.
class V4l2Camera final : public FrameSource {
 public:
  /// `system` outlives the camera. Throws std::bad_alloc and std::system_error.
  V4l2Camera(VideoSystem& system, std::shared_ptr<V4l2PairState> pair, Side side, const CamerasConfig& config,
             CameraLog log);

  Size frame_size() const override { return size_; }
  FrameLease next(std::chrono::milliseconds timeout) noexcept override;
  SourceState state() const noexcept override;
  void stop() noexcept override;
  SourceReport report() const override;
  /// Why it does not stream; kNone if it does. Any thread.
  CameraFault fault() const;
  std::int64_t frame_time_ns() const noexcept override { return frame_time_ns_; }

 private:
  enum class Phase { kClosed, kFlowing, kClosing };

  FrameLease step(std::int64_t until_ns);
  void wait_for_device(std::int64_t until_ns);
  void open();
  void opened();
  void started();
  bool wait_for_other();
  void count_refusal(const CameraFault& fault);
  std::optional<CameraFault> find_and_open();
  FrameLease fetch(std::int64_t until_ns);
  void streaming();
  void check_silence(std::int64_t now_ns);
  void finish_closing(std::int64_t until_ns);
  void lose(CameraFault fault);
  void fail(CameraState state, CameraFault fault);
  void out_of_memory(const std::exception& error) noexcept;
  void no_bandwidth(CameraFault& fault);
  void change_format();
  void restart_in_phase();
  void sync_exposure();
  void set_note(const std::string& note);
  std::int64_t patience_ns() const noexcept;

  VideoSystem& system_;
  const std::shared_ptr<V4l2PairState> pair_;
  const Side side_;
  const CamerasConfig config_;
  const Size size_;
  const CameraLog log_;
  const std::unique_ptr<Waiter> waiter_;
  std::atomic<bool> stopping_{false};
  std::atomic<CameraState> state_{CameraState::kAbsent};

  // The camera's own thread's.
  CameraStream stream_;
  ExposureSync exposure_;
  Phase phase_ = Phase::kClosed;
  std::string name_;  // what to look for
  std::string node_;  // what it was found as
  int fallback_level_ = 0;
  std::int64_t retry_ns_ = 0;    // when to look again
  std::int64_t refused_ns_ = 0;  // since when the other camera has what this one is to be; 0: it has not
  std::int64_t last_good_ns_ = 0;
  std::int64_t buffers_at_last_good_ = 0;
  bool had_frame_ = false;       // since it was opened
  bool restart_wanted_ = false;  // to bring it into phase with the other camera
  // From a start to its first frame, since it was plugged in; 0: none came.
  std::int64_t longest_start_ns_ = 0;
  unsigned starts_in_vain_ = 0;  // since it last had a frame or was plugged in
  int refusals_ = 0;             // how often in a row the driver did not take the format
  int silent_starts_ = 0;        // how often it was opened in vain while the other camera had the bus
  std::atomic<std::int64_t> frame_time_ns_{0};

  mutable std::mutex mutex_;  // guards what follows, for report()
  CameraFault fault_;         // why it does not stream
  CameraReason logged_ = CameraReason::kNone;
  bool ever_streamed_ = false;
  std::string device_, format_, note_, last_fault_;
  std::int64_t last_fault_ns_ = 0;
  std::int64_t reconnects_ = 0;
};

}  // namespace stereod
