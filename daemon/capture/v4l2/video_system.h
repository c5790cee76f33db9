// The kernel's side of cameras, small enough to be faked: descriptors, ioctls, mappings, waiting, what is
// plugged in.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace stereod {

/// Why a wait ended; several may be true, none if the time ran out.
struct WaitResult {
  bool readable = false;         ///< a frame can be dequeued
  bool broken = false;           ///< the device reports an error or is gone
  bool devices_changed = false;  ///< a device came, went, or got other permissions
};

/// What one camera's thread waits with.
class Waiter {
 public:
  virtual ~Waiter() = default;

  /// Waits for the descriptor to have a frame, or with -1 for devices to change. Ends early after wake().
  virtual WaitResult wait(int descriptor, std::chrono::milliseconds timeout) noexcept = 0;

  /// Ends the wait that goes on, and every one after it at once. Any thread.
  virtual void wake() noexcept = 0;
};

/// A video node of the system. Not every one is a camera: UVC cameras have a second one for metadata.
struct VideoNode {
  std::string node;                ///< /dev/video0
  std::vector<std::string> links;  ///< its stable names below /dev/v4l/by-path and by-id
  std::string serial;              ///< of the USB device; empty if it has none
};

/// What the daemon asks of the kernel. Any thread; an error is an errno value, 0 is success. Only open(),
/// nodes() and make_waiter() may allocate or throw.
class VideoSystem {
 public:
  virtual ~VideoSystem() = default;

  /// Every video node, sorted by its first stable name, then by number.
  virtual std::vector<VideoNode> nodes() = 0;
  /// The node that a name below /dev stands for now, its links followed; empty if there is none.
  virtual std::string resolve(const std::string& name) = 0;
  /// What tells one camera from another: the same for two nodes of one USB video function, which share a
  /// sensor. Two functions of one device are two cameras; a stereo webcam has those. The node itself for what
  /// is not on USB.
  virtual std::string camera_of(const std::string& node) = 0;
  virtual std::unique_ptr<Waiter> make_waiter() = 0;

  /// Opens a node without blocking; a descriptor, or minus an errno value. `convert`: through libv4l2, which
  /// then offers formats the camera itself does not have.
  virtual int open(const std::string& node, bool convert) = 0;
  virtual void close(int descriptor) noexcept = 0;
  virtual int ioctl(int descriptor, unsigned long request, void* argument) noexcept = 0;
  /// Null if it cannot be mapped; then `error` says why.
  virtual void* map(int descriptor, std::size_t length, std::int64_t offset, int& error) noexcept = 0;
  virtual void unmap(void* memory, std::size_t length) noexcept = 0;
  /// CLOCK_MONOTONIC, the clock of the drivers' time stamps.
  virtual std::int64_t now_ns() noexcept = 0;
  /// Sleeps to the moment, for what has to be done just then.
  virtual void sleep_until(std::int64_t time_ns) noexcept = 0;
};

/// The system this program runs on. Throws std::system_error.
std::unique_ptr<VideoSystem> make_kernel_video_system();

}  // namespace stereod
