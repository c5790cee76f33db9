// A camera that has been opened: its format, its buffers, and the frames that come through them.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/capture/frame_source.h"
#include "daemon/capture/v4l2/camera_fault.h"
#include "daemon/capture/v4l2/format_fallbacks.h"
#include "daemon/capture/v4l2/frame_check.h"
#include "daemon/capture/v4l2/luma_decoder.h"
#include "daemon/capture/v4l2/video_device.h"

namespace stereod {

/// How a camera is opened.
struct StreamOptions {
  std::string node;  ///< /dev/video0
  Size size;         ///< of the frames
  double fps = 30;
  std::string format = "auto";
  int fallback_level = 0;  ///< how far down the ladder of formats; past its end: the last one
};

/// What came of it.
struct StreamInfo {
  DeviceCapability device;
  DeviceFormat format;
  const PixelFormat* pixels = nullptr;
  bool converted = false;   ///< by libv4l2
  double fps = 0;           ///< as the driver says, else as asked
  int fallback_levels = 0;  ///< how many steps the ladder of formats has
};
/// "MJPEG 640×480 at 30/s", for people.
std::string describe(const StreamInfo& info);

/// Life: open() sets the camera up, start() lets frames flow, newest() fetches them, stop() ends the flow,
/// and close() gives everything back, for which no frame may be on loan (on_loan()). Frames on loan after
/// stop() stay valid. All but give_back(), which any thread may call, belongs to the camera's own thread.
/// Between start() and stop() nothing is allocated.
class CameraStream final : public BufferOwner {
 public:
  /// Throws std::bad_alloc.
  CameraStream(VideoSystem& system, Size size);
  ~CameraStream();
  CameraStream(const CameraStream&) = delete;
  CameraStream& operator=(const CameraStream&) = delete;

  /// Sets the camera up; a failure leaves it closed.
  std::optional<CameraFault> open(const StreamOptions& options);
  /// Queues every buffer that is not on loan and starts the stream.
  std::optional<CameraFault> start(std::int64_t exposure_ns);
  /// Whether frames have to be waited for on this descriptor; -1 if it is closed.
  int descriptor() const noexcept { return device_.descriptor(); }
  /// The newest frame that is ready and whole; an empty lease if there is none. An errno value in `error` if
  /// the driver failed, from here or from a buffer given back.
  FrameLease newest(int& error, SetupStage& step) noexcept;
  void stop() noexcept;
  bool on_loan() noexcept;
  void close() noexcept;

  VideoDevice& device() noexcept { return device_; }
  const StreamInfo& info() const { return info_; }
  DropCounts drops() const noexcept;
  /// What was wrong with the last frame that was damaged. The camera's own thread.
  FrameDrop last_damage() const noexcept { return last_damage_; }
  /// Frames since start(), good or not.
  std::int64_t buffers_seen() const noexcept { return buffers_seen_; }
  /// Frames that the camera counted and that never came here, since the beginning. Any thread.
  std::int64_t frames_missed() const noexcept { return frames_missed_; }

  void give_back(int buffer) noexcept override;

 private:
  // What the pipeline may hold of one camera (waiting, in a pair, being matched), and as many for the driver.
  static constexpr std::uint32_t kDriverBuffers = 6;
  static constexpr int kImages = 5;

  std::optional<CameraFault> set_up(const StreamOptions& options);
  std::optional<CameraFault> choose(const StreamOptions& options, FormatRequest& request);
  std::optional<CameraFault> agree_on_format(const StreamOptions& options, const FormatRequest& request);
  std::optional<CameraFault> map_buffers(const std::string& node);
  CameraFault no_format(const StreamOptions& options, const std::vector<OfferedFormat>& offers) const;
  bool dequeue_newest(FilledBuffer& newest, std::int64_t& start_ns, int& error, SetupStage& step) noexcept;
  FrameLease lend_in_place(const FilledBuffer& buffer, Frame frame) noexcept;
  FrameLease lend_image(const FilledBuffer& buffer, Frame frame, int& error) noexcept;
  int free_image() noexcept;
  void requeue(std::uint32_t index, int& error) noexcept;
  void count_missed(std::uint32_t sequence) noexcept;
  void count(FrameDrop drop) noexcept;

  VideoSystem& system_;
  VideoDevice device_;
  StreamInfo info_;
  std::vector<std::span<const std::uint8_t>> buffers_;
  JpegLumaDecoder jpeg_;
  std::vector<GrayImage> pictures_;  // decoded or scaled ones
  TimestampFilter timestamps_;
  std::int64_t buffers_seen_ = 0;
  FrameDrop last_damage_{};
  std::uint32_t next_sequence_ = 0;
  std::atomic<std::int64_t> frames_missed_{0};

  mutable std::mutex mutex_;  // guards what follows
  bool flowing_ = false;
  std::vector<bool> buffer_on_loan_;
  std::vector<bool> image_on_loan_;
  int give_back_error_ = 0;
  DropCounts drops_;
};

}  // namespace stereod
