// SPDX-License-Identifier: BSD-3-Clause
// A video node: V4L2's requests as typed calls. No other file of the daemon uses V4L2's structures.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "daemon/capture/v4l2/video_system.h"
#include "daemon/capture/v4l2/video_types.h"

namespace stereod::v4l2 {

/// Owns the descriptor of a video node. Calls that return int return 0 or an errno value. The calls of the
/// per-frame path (queue, dequeue) neither allocate nor throw.
class VideoDevice {
 public:
  /// @p system must outlive the device.
  explicit VideoDevice(VideoSystem& system) : system_(&system) {}
  ~VideoDevice() { close(); }
  VideoDevice(const VideoDevice&) = delete;
  VideoDevice& operator=(const VideoDevice&) = delete;

  /// Opens @p node, after closing the previous one. @p convert: through libv4l2.
  int open(const std::string& node, bool convert);
  void close() noexcept;
  /// Returns -1 if no node is open.
  int descriptor() const noexcept { return descriptor_; }

  int capability(DeviceCapability& capability);

  /// Lists the pixel formats in the driver's order; empty if the driver lists none.
  int formats(std::vector<std::uint32_t>& formats);
  /// Sets @p offered if the driver offers @p size in this format. A driver that lists no sizes may offer any.
  int offers_size(std::uint32_t fourcc, Size size, bool& offered);
  /// Returns every size that the driver lists for a format; of a range, its two ends.
  std::vector<Size> sizes(std::uint32_t fourcc);
  OfferedRates rates(std::uint32_t fourcc, Size size);

  /// Requests a format and replaces it by the one that the driver chose.
  int set_format(DeviceFormat& format);
  /// Requests a frame rate [Hz]; @p actual is the one that the driver chose, 0 if its rate cannot be set.
  int set_rate(double fps, double& actual);

  /// Requests @p count buffers and replaces it by the number that the driver granted.
  int request_buffers(std::uint32_t& count) noexcept;
  /// Maps one buffer for reading.
  int map_buffer(std::uint32_t index, std::span<const std::uint8_t>& memory) noexcept;
  void unmap_buffer(std::span<const std::uint8_t> memory) noexcept;
  int queue(std::uint32_t index) noexcept;
  /// Returns EAGAIN if no buffer is filled.
  int dequeue(FilledBuffer& buffer) noexcept;
  int stream_on() noexcept;
  int stream_off() noexcept;

  /// Lists the integer, boolean and menu controls.
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

}  // namespace stereod::v4l2
