// A video node with V4L2's requests as typed calls. Nothing else in the daemon knows V4L2's structures.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "daemon/capture/v4l2/video_system.h"

namespace stereod {

/// Four letters that name a pixel format, as V4L2 writes them.
constexpr std::uint32_t fourcc(char a, char b, char c, char d) {
  const auto byte = [](char letter) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(letter));
  };
  return byte(a) | byte(b) << 8 | byte(c) << 16 | byte(d) << 24;
}
/// "YUYV", for people; what is no letter becomes '?'.
std::string fourcc_name(std::uint32_t format);

struct DeviceCapability {
  std::string card;       ///< the camera's name
  std::string bus;        ///< where it is plugged in: usb-0000:00:14.0-3
  bool captures = false;  ///< gives images; a metadata node does not
  bool streams = false;   ///< into mapped buffers
};

/// How images lie in a buffer.
struct DeviceFormat {
  std::uint32_t pixels = 0;  ///< fourcc
  Size size;
  std::uint32_t bytes_per_line = 0;
  std::uint32_t image_bytes = 0;
  friend bool operator==(const DeviceFormat&, const DeviceFormat&) = default;
};

/// A buffer that the driver has filled.
struct FilledBuffer {
  std::uint32_t index = 0;
  std::uint32_t bytes = 0;
  std::uint32_t sequence = 0;
  std::int64_t timestamp_ns = 0;
  bool error = false;                ///< the driver says that the image is damaged
  bool timestamp_monotonic = false;  ///< else the stamp's clock is not known
  bool timestamp_start = false;      ///< of the exposure; else the end of the frame
};

struct DeviceControl {
  std::uint32_t id = 0;
  std::string name;  ///< exposure_time_absolute
  std::int32_t least = 0, most = 0, step = 1, preset = 0;
  bool writable = true;
};

/// Frames a second.
struct OfferedRates {
  std::vector<double> listed;  ///< fastest first; empty: it does not say
  bool range = false;          ///< two are listed, and what lies between is offered too
};

/// Owns the descriptor. Calls return 0 or an errno value; those on the per-frame path (queue, dequeue, wait)
/// allocate nothing.
class VideoDevice {
 public:
  explicit VideoDevice(VideoSystem& system) : system_(&system) {}
  ~VideoDevice() { close(); }
  VideoDevice(const VideoDevice&) = delete;
  VideoDevice& operator=(const VideoDevice&) = delete;

  int open(const std::string& node, bool convert);
  void close() noexcept;
  bool is_open() const noexcept { return descriptor_ >= 0; }
  int descriptor() const noexcept { return descriptor_; }

  int capability(DeviceCapability& capability);

  /// The pixel formats it offers, in its own order; empty if it does not say.
  int formats(std::vector<std::uint32_t>& formats);
  /// Whether it offers this size in this format. A driver that does not list sizes may offer any.
  int offers_size(std::uint32_t pixels, Size size, bool& offered);
  /// Every size it lists for a format; for a range, its ends.
  std::vector<Size> sizes(std::uint32_t pixels);
  /// The frame rates it lists.
  OfferedRates rates(std::uint32_t pixels, Size size);

  /// Asks for a format and tells which one the driver made of it.
  int set_format(DeviceFormat& format);
  /// Asks for a frame rate and tells which one the driver made of it; 0 if it has none to set.
  int set_rate(double fps, double& got);

  int request_buffers(std::uint32_t& count) noexcept;
  /// Maps one buffer for reading.
  int map_buffer(std::uint32_t index, std::span<const std::uint8_t>& memory) noexcept;
  void unmap_buffer(std::span<const std::uint8_t> memory) noexcept;
  int queue(std::uint32_t index) noexcept;
  int dequeue(FilledBuffer& buffer) noexcept;
  int stream_on() noexcept;
  int stream_off() noexcept;

  /// The integer, boolean and menu controls.
  std::vector<DeviceControl> controls();
  int get_control(std::uint32_t id, std::int32_t& value) noexcept;
  int set_control(std::uint32_t id, std::int32_t value) noexcept;

 private:
  int request(unsigned long code, void* argument) noexcept {
    return system_->ioctl(descriptor_, code, argument);
  }

  VideoSystem* system_;
  int descriptor_ = -1;
};

}  // namespace stereod
