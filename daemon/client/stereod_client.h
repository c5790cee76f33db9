// libstereod-client: what another program needs to use what stereod publishes. C++17; this header, its source
// and the classes that lcm-gen makes of the .lcm files are all of it.
//
//   stereod::StereoClient client(stereod::StereoClient::Options{});
//   client.on_frame([](stereod::StereoFrame&& frame) { use(frame.depth_m(320, 240)); });
//   while (true) client.handle(100);
//
// Nothing that comes over the network is believed: what is no message, or contradicts itself, is counted as
// ignored.
#pragma once

#include <lcm/lcm.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "stereod/camera_info_t.hpp"
#include "stereod/disparity_rows_t.hpp"
#include "stereod/frame_t.hpp"

namespace stereod {

/// A point in meters: x to the right, y down, z forward, from the left camera.
struct StereoPoint {
  float x = 0, y = 0, z = 0;
};

/// The rectified camera, as far as depth needs it.
struct CameraGeometry {
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< px
  double baseline_m = 0;
  double disparity_offset = 0;  ///< px, added to a disparity before it is turned into depth

  /// Meters along the optical axis; infinite at the horizon and beyond it.
  double depth_m(double disparity_px) const;
  /// The point that the left image shows at (x, y); its coordinates are not finite where depth is not.
  StereoPoint point(double x, double y, double disparity_px) const;
};

/// What the message says; nothing if there is no calibration, or if its numbers make no sense.
std::optional<CameraGeometry> geometry_of(const camera_info_t& info);

/// Which pixels of the rectified image the daemon publishes: pixel (u, v) of what it publishes is pixel
/// (image_x(u), image_y(v)) there.
struct PixelGrid {
  int left = 0, top = 0;                   ///< px
  int decimation_x = 1, decimation_y = 1;  ///< px, ≥ 1

  int image_x(int u) const { return left + u * decimation_x; }
  int image_y(int v) const { return top + v * decimation_y; }
  friend bool operator==(const PixelGrid& a, const PixelGrid& b) {
    return a.left == b.left && a.top == b.top && a.decimation_x == b.decimation_x &&
           a.decimation_y == b.decimation_y;
  }
};

/// Which disparities are wanted.
enum class Pixels {
  kMeasured,          ///< only those that were matched
  kMeasuredOrFilled,  ///< also those that the daemon took from their neighbors because it found no match
};

/// Disparities in fixed point, row after row.
class DisparityMap {
 public:
  static constexpr std::int16_t kNone = -1;  ///< no trustworthy match, or the row did not arrive

  DisparityMap() = default;
  DisparityMap(int width, int height)
      : width_(width),
        height_(height),
        values_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kNone) {}

  int width() const { return width_; }
  int height() const { return height_; }
  /// (x, y) lies in the image.
  std::int16_t at(int x, int y) const { return row(y)[x]; }
  std::int16_t* row(int y) { return values_.data() + static_cast<std::ptrdiff_t>(y) * width_; }
  const std::int16_t* row(int y) const { return values_.data() + static_cast<std::ptrdiff_t>(y) * width_; }

 private:
  int width_ = 0;
  int height_ = 0;
  std::vector<std::int16_t> values_;
};

/// A frame put together again, as far as it arrived.
struct StereoFrame {
  std::int64_t frame = 0;
  std::int64_t utime = 0;          ///< µs since the Unix epoch, exposure of the left frame
  DisparityMap disparity;          ///< measured, in units of 1 / units_per_pixel px
  DisparityMap filled;             ///< those not measured but filled in, the same way; 0×0 if there are none
  PixelGrid grid;                  ///< where the pixels of `disparity` are in the rectified image
  int units_per_pixel = 1;         ///< 1 or 16
  int min_disparity = 0;           ///< px
  int disparities = 0;             ///< px; 0 if not one row arrived
  std::vector<bool> row_present;   ///< one for each row of the image
  int rows_expected = 0;           ///< as many as the daemon says it published, or else the image's height
  int rows_received = 0;           ///< never more than rows_expected
  std::optional<frame_t> summary;  ///< nothing if the daemon's message about this frame did not arrive
  std::optional<CameraGeometry> camera;  ///< nothing before the camera_info came, or without calibration

  bool complete() const { return summary.has_value() && rows_received >= rows_expected; }

  /// Of a pixel of `disparity`: px of the rectified image, or NaN if there is none.
  float disparity_px(int x, int y, Pixels pixels = Pixels::kMeasured) const;
  /// Meters along the optical axis; NaN if there is no disparity or no camera, infinite at the horizon.
  float depth_m(int x, int y, Pixels pixels = Pixels::kMeasured) const;
  /// NaN in every coordinate where depth is NaN or infinite.
  StereoPoint point(int x, int y, Pixels pixels = Pixels::kMeasured) const;

  /// depth_m() of every pixel, row after row.
  std::vector<float> depths_m(Pixels pixels = Pixels::kMeasured) const;
  /// The points of every `step`-th row and column (≥ 1) of `disparity` that have one.
  std::vector<StereoPoint> points(int step = 1, Pixels pixels = Pixels::kMeasured) const;
};

/// Some rows, as they came: valid during the call that hands it over. Its numbers agree with each other.
class RowBlock {
 public:
  explicit RowBlock(const disparity_rows_t& message) : message_(message) {}

  const disparity_rows_t& message() const { return message_; }
  int units_per_pixel() const { return message_.scale == 1.0F ? 1 : 16; }
  PixelGrid grid() const {
    return {message_.left, message_.top, message_.decimation_x, message_.decimation_y};
  }
  /// In units of 1 / units_per_pixel() px, or DisparityMap::kNone. `y` is a row of what is published,
  /// first_row ≤ y < first_row + row_count.
  std::int16_t at(int x, int y, Pixels pixels = Pixels::kMeasured) const;
  /// Whether there is a value that was not measured but filled in.
  bool is_filled(int x, int y) const;
  bool has_filled() const { return message_.filled_size > 0; }
  /// A whole row of at(), message().width values.
  void copy_row(int y, std::int16_t* out, Pixels pixels = Pixels::kMeasured) const;

 private:
  const disparity_rows_t& message_;
};

/// What arrived and what did not. A frame is counted once it is settled: when two newer ones have begun, or
/// at finish(). The frame in which the listening began, and the one in which it ended, count only if
/// complete.
struct ReceptionCounts {
  std::int64_t frames_expected = 0;  ///< by their numbers; the sum of the next three
  std::int64_t frames_complete = 0;
  std::int64_t frames_incomplete = 0;  ///< rows or the message about the frame missing
  std::int64_t frames_missing = 0;     ///< nothing of them arrived
  std::int64_t rows_expected = 0;      ///< the sum of the next two
  std::int64_t rows_received = 0;
  std::int64_t rows_lost = 0;
  std::int64_t rows_duplicate = 0;
  std::int64_t messages_late = 0;     ///< about frames that were handed over already
  std::int64_t messages_ignored = 0;  ///< contradictory, out of range, or numbered like no frame near
  /// Of these: sane ones about a frame of the same number with another exposure or size, as a second stereod
  /// on the same channels sends them.
  std::int64_t messages_of_another = 0;
  std::int64_t restarts = 0;  ///< times the numbering began anew, with the daemon
};

/// What these counts say is wrong, and what to do, in sentences; empty if nothing is.
std::string describe_problems(const ReceptionCounts& counts);

/// Takes the messages of one daemon in any order and hands each frame over once, in the order of their
/// numbers: as soon as it is complete, else when the next one is, or when two newer ones have begun.
/// Numbers that jump by more than 100, or whose exposures are too far apart for them (a daemon that was
/// started again), are followed after three messages in a row that agree. Knows nothing of LCM; not
/// thread-safe.
class FrameAssembler {
 public:
  using Handler = std::function<void(StereoFrame&&)>;

  explicit FrameAssembler(Handler handler) : handler_(std::move(handler)) {}

  /// Any message whatever; what is not sane is counted as ignored.
  void take(const disparity_rows_t& rows);
  void take(const frame_t& summary);

  /// A message that could not even be decoded.
  void count_ignored() { ++counts_.messages_ignored; }

  /// Hands over and counts what is still open. The next message begins anew.
  void finish();

  const ReceptionCounts& counts() const { return counts_; }

 private:
  enum class State { kAbsent, kOpen, kHandedOver };
  struct Slot {
    State state = State::kAbsent;
    bool has_rows = false;
    StereoFrame out;
  };

  Slot* slot_for(std::int64_t frame, std::int64_t utime, int width, int height);
  bool belongs_to_numbering(std::int64_t frame, std::int64_t utime) const;
  bool follow_jump(std::int64_t frame);
  void begin_numbering(std::int64_t frame);
  void advance_to(std::int64_t frame);
  void settle(std::int64_t frame, bool last);
  void count_settled(const Slot& slot);
  void complete(Slot& slot);
  void hand_over(Slot& slot);
  Slot& slot(std::int64_t frame) { return slots_[static_cast<std::size_t>(frame & 1)]; }

  Handler handler_;
  ReceptionCounts counts_;
  std::array<Slot, 2> slots_;  // the newest frame and the one before it
  bool started_ = false;
  std::int64_t joined_ = 0;       // the frame in which this numbering was first heard
  std::int64_t oldest_open_ = 0;  // the oldest one not settled
  std::int64_t newest_ = 0;
  std::int64_t newest_utime_ = 0;
  std::int64_t jump_frame_ = 0;  // where the numbering seems to have jumped to
  int jump_messages_ = 0;        // how many messages in a row say so
  int height_ = 0;               // of the latest frame: what a missing one is taken to have had
};

/// True if rows can be what stereod sends: every number in its range, the data as long as they say.
bool is_valid(const disparity_rows_t& rows);
bool is_valid(const frame_t& summary);

/// How a message lies on the wire after its fingerprint, a letter a field: b 1 byte, i 4 bytes, d 8 bytes,
/// s a string (its length with the closing zero, then that), v a byte array (its length, then the bytes), f
/// an array of floats (their number, then 4 bytes each), z a number that has to be 0: of structs that stereod
/// never sends.
template <typename Message>
inline constexpr std::string_view kWireLayout;
template <>
inline constexpr std::string_view kWireLayout<disparity_rows_t> = "ddiiiiiiiiiiibibvvv";
template <>
inline constexpr std::string_view kWireLayout<frame_t> = "ddiiiiiiibsddiiiiiiibbii";
template <>
inline constexpr std::string_view kWireLayout<camera_info_t> = "diibbddddddiisdddddd";

/// True if the bytes are a fingerprint and exactly the fields of `layout`, every length inside the bytes.
bool has_layout(const void* bytes, std::size_t size, std::string_view layout) noexcept;

/// Decodes a message; false if the bytes are not one. Checks the layout first, because the code that lcm-gen
/// makes believes the lengths it reads: a string length of 0 throws, one of -2^31 reads past the end, and an
/// array may ask for 2 GB.
template <typename Message>
bool decode_message(const void* bytes, std::size_t size, Message& message) noexcept {
  static_assert(!kWireLayout<Message>.empty(), "say how this message lies on the wire");
  if (!has_layout(bytes, size, kWireLayout<Message>)) return false;
  try {
    return message.decode(bytes, 0, static_cast<int>(size)) == static_cast<int>(size);
  } catch (const std::exception&) {  // out of memory
    return false;
  }
}

/// Subscribes to one daemon. Not thread-safe; everything is handed over by the thread that calls handle().
class StereoClient {
 public:
  struct Options {
    std::string url;                ///< empty: LCM_DEFAULT_URL, or else LCM's own default
    std::string prefix = "STEREO";  ///< of the channels
    int receive_buffer =
        4 << 20;                ///< bytes, unless the URL has recv_buf_size; the kernel's rmem_max limits it
    int queue_messages = 1000;  ///< how many wait in a queue for a program that is late; more are lost
    bool latest_only = true;    ///< handle() reads all that waits and hands over only the newest frame
  };

  /// Opens LCM and subscribes. Throws std::runtime_error with a sentence.
  explicit StereoClient(const Options& options);
  /// Subscribes with an LCM that the program has already and handles itself; it outlives the client. Every
  /// frame is handed over from within lcm_handle(), and what a handler throws ends the program, because LCM
  /// is C.
  StereoClient(lcm_t* lcm, const std::string& prefix);
  ~StereoClient();
  StereoClient(const StereoClient&) = delete;
  StereoClient& operator=(const StereoClient&) = delete;

  /// Whole frames, or as much of them as arrived.
  void on_frame(std::function<void(StereoFrame&&)> handler) { on_frame_ = std::move(handler); }
  /// Rows at once, in whatever order they come: the lowest latency.
  void on_rows(std::function<void(const RowBlock&)> handler) { on_rows_ = std::move(handler); }
  /// About once a second, calibrated or not.
  void on_camera_info(std::function<void(const camera_info_t&)> handler) {
    on_camera_info_ = std::move(handler);
  }

  /// Waits up to `timeout_ms` for a message, then handles all that wait; false if none came. Throws what a
  /// handler throws, and std::runtime_error at the end of a log file.
  bool handle(int timeout_ms);

  /// Becomes readable when handle() has something to do: for poll() and event loops.
  int file_descriptor() const;

  const ReceptionCounts& counts() const { return assembler_.counts(); }
  std::int64_t frames_skipped() const { return frames_skipped_; }  ///< by latest_only
  const std::optional<CameraGeometry>& camera() const { return camera_; }

  /// What a message on one of the channels does, for bytes that came on another way than LCM's network.
  void take_rows(const void* bytes, std::size_t size);
  void take_frame(const void* bytes, std::size_t size);
  void take_camera_info(const void* bytes, std::size_t size);

  /// A client that is subscribed to nothing: its bytes come by the three functions above.
  static std::unique_ptr<StereoClient> unconnected();

 private:
  using Taker = void (StereoClient::*)(const void*, std::size_t);
  struct Subscription;

  StereoClient();
  void subscribe(const std::string& prefix, int queue_messages);
  void hand_over(StereoFrame&& frame);
  static void on_message(const lcm_recv_buf_t* message, const char* channel, void* subscription);

  struct LcmCloser {
    void operator()(lcm_t* lcm) const noexcept;
  };
  std::unique_ptr<lcm_t, LcmCloser> owned_;
  lcm_t* lcm_ = nullptr;
  std::vector<std::unique_ptr<Subscription>> subscriptions_;
  std::exception_ptr error_;
  FrameAssembler assembler_;
  disparity_rows_t rows_{};  // kept so that its memory is used again
  std::optional<CameraGeometry> camera_;
  std::optional<StereoFrame> waiting_;  // with latest_only
  bool newest_frame_only_ = false;
  std::int64_t frames_skipped_ = 0;
  std::function<void(StereoFrame&&)> on_frame_;
  std::function<void(const RowBlock&)> on_rows_;
  std::function<void(const camera_info_t&)> on_camera_info_;
};

}  // namespace stereod
