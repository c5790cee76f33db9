// SPDX-License-Identifier: BSD-3-Clause
// The kernel's side of cameras, small enough to be faked in tests: descriptors, ioctls, mappings, waiting,
// and which devices are plugged in.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace stereod::v4l2 {

/// Why a wait ended. Several members may be true; none is true after the timeout.
struct WaitResult {
  bool readable = false;         ///< a frame can be dequeued
  bool broken = false;           ///< the device reports an error or was unplugged
  bool devices_changed = false;  ///< a device was added or removed, or its permissions changed
};

/// Blocks the thread of one camera.
class Waiter {
 public:
  virtual ~Waiter() = default;

  /// Blocks until @p descriptor has a frame (-1: until devices change), until @p timeout, or until wake().
  virtual WaitResult wait(int descriptor, std::chrono::milliseconds timeout) noexcept = 0;

  /// Ends the current wait and makes every later one return at once. Any thread.
  virtual void wake() noexcept = 0;
};

/// A video node. Not every node captures images: a UVC camera has a second one for metadata.
struct VideoNode {
  std::string node;                ///< /dev/video0
  std::vector<std::string> links;  ///< its stable names in /dev/v4l/by-path and by-id
  std::string serial;              ///< of the USB device; empty if the device has none
};

/// The daemon's requests to the kernel. Any thread. An error is an errno value, 0 is success. Only open(),
/// nodes() and make_waiter() may allocate or throw.
class VideoSystem {
 public:
  virtual ~VideoSystem() = default;

  /// Returns every video node, sorted by its first stable name, then by its number.
  virtual std::vector<VideoNode> nodes() = 0;
  /// Returns the node that a path in /dev refers to now, with its links followed; empty if there is none.
  virtual std::string resolve(const std::string& name) = 0;
  /// Returns a name that is the same for all nodes of one camera: its USB video function, or the node itself
  /// for a device that is not on USB. Two nodes of one function share a sensor. Two functions of one device
  /// are two cameras, as in a stereo webcam.
  virtual std::string camera_id(const std::string& node) = 0;
  virtual std::unique_ptr<Waiter> make_waiter() = 0;

  /// Opens a node for non-blocking use. Returns a descriptor, or a negative errno value. @p convert: through
  /// libv4l2, which converts formats that the daemon does not read.
  virtual int open(const std::string& node, bool convert) = 0;
  virtual void close(int descriptor) noexcept = 0;
  virtual int ioctl(int descriptor, unsigned long request, void* argument) noexcept = 0;
  /// Returns null on failure and sets @p error to an errno value.
  virtual void* map(int descriptor, std::size_t length, std::int64_t offset, int& error) noexcept = 0;
  virtual void unmap(void* memory, std::size_t length) noexcept = 0;
  /// Returns CLOCK_MONOTONIC, the clock of the drivers' timestamps.
  virtual std::int64_t now_ns() noexcept = 0;
  /// Blocks until @p time_ns of CLOCK_MONOTONIC.
  virtual void sleep_until(std::int64_t time_ns) noexcept = 0;
};

/// Returns access to the running kernel.
std::unique_ptr<VideoSystem> make_kernel_video_system();

}  // namespace stereod::v4l2
