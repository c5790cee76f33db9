// SPDX-License-Identifier: BSD-3-Clause
// Calls the kernel. No other file of the daemon makes system calls on video devices.
#include <fcntl.h>
#include <libv4l2.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <map>
#include <system_error>
#include <tuple>

#include "daemon/capture/v4l2/video_system.h"

namespace stereod::v4l2 {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWatchedDirectories[] = {"/dev", "/dev/v4l", "/dev/v4l/by-path", "/dev/v4l/by-id"};
constexpr const char* kLinkDirectories[] = {"/dev/v4l/by-path", "/dev/v4l/by-id"};

/// Watches for devices with inotify: udev creates and removes nodes and links in these directories and sets
/// their permissions.
class KernelWaiter final : public Waiter {
 public:
  KernelWaiter() : inotify_(inotify_init1(IN_NONBLOCK | IN_CLOEXEC)), wake_(eventfd(0, EFD_CLOEXEC)) {
    if (inotify_ < 0 || wake_ < 0) {
      const int error = errno;
      close_all();
      throw std::system_error(error, std::generic_category(), "cannot watch /dev for cameras");
    }
    watch();
  }
  ~KernelWaiter() override { close_all(); }
  KernelWaiter(const KernelWaiter&) = delete;
  KernelWaiter& operator=(const KernelWaiter&) = delete;

  WaitResult wait(int descriptor, std::chrono::milliseconds timeout) noexcept override {
    // While a camera streams, only its own descriptor is polled.
    std::array<pollfd, 2> polled{{{wake_, POLLIN, 0}, {descriptor >= 0 ? descriptor : inotify_, POLLIN, 0}}};
    const int ready = poll(polled.data(), polled.size(), static_cast<int>(timeout.count()));
    WaitResult result;
    if (ready <= 0) return result;
    if (descriptor >= 0) {
      result.readable = (polled[1].revents & POLLIN) != 0;
      result.broken = (polled[1].revents & (POLLERR | POLLHUP | POLLNVAL)) != 0;
    } else if ((polled[1].revents & POLLIN) != 0) {
      result.devices_changed = video_device_changed();
    }
    return result;
  }

  void wake() noexcept override {
    // The counter is never read, so that every later wait ends at once.
    const std::uint64_t one = 1;
    if (write(wake_, &one, sizeof one) < 0) return;  // the counter is full and so already readable
  }

 private:
  // The directories in /dev/v4l are created and removed with the cameras. Watching one a second time has no
  // effect.
  void watch() noexcept {
    for (const char* directory : kWatchedDirectories) {
      inotify_add_watch(inotify_, directory, IN_CREATE | IN_DELETE | IN_MOVED_TO | IN_ATTRIB | IN_ONLYDIR);
    }
  }

  // Empties the queue of events and returns true if one of them may concern a camera.
  bool video_device_changed() noexcept {
    alignas(inotify_event) std::array<char, 4096> buffer;
    bool changed = false;
    while (true) {
      const ssize_t size = read(inotify_, buffer.data(), buffer.size());
      if (size <= 0) break;
      for (ssize_t at = 0; at < size;) {
        const auto* event = reinterpret_cast<const inotify_event*>(buffer.data() + at);
        const std::string_view name = event->len > 0 ? event->name : "";
        changed = changed || name.find("video") != name.npos || name.starts_with("v4l") ||
                  name.starts_with("by-") || (event->mask & (IN_Q_OVERFLOW | IN_IGNORED)) != 0;
        at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
      }
    }
    if (changed) watch();
    return changed;
  }

  void close_all() noexcept {
    if (inotify_ >= 0) ::close(inotify_);
    if (wake_ >= 0) ::close(wake_);
  }

  int inotify_;
  int wake_;
};

std::string first_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

/// Returns N of /dev/videoN, -1 for another name.
int node_number(const std::string& name) {
  constexpr std::string_view kStem = "video";
  int number = -1;
  if (!name.starts_with(kStem)) return -1;
  const char* end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data() + kStem.size(), end, number);
  return error == std::errc{} && stop == end ? number : -1;
}

class KernelVideoSystem final : public VideoSystem {
 public:
  std::vector<VideoNode> nodes() override {
    std::map<int, VideoNode> found;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator("/dev", error)) {
      const int number = node_number(entry.path().filename());
      if (number < 0) continue;
      VideoNode& node = found[number];
      node.node = entry.path();
      const fs::path interface =
          fs::canonical("/sys/class/video4linux/" + entry.path().filename().string() + "/device", error);
      if (!error) node.serial = first_line(interface.parent_path() / "serial");
    }
    for (const char* directory : kLinkDirectories) {
      for (const fs::directory_entry& entry : fs::directory_iterator(directory, error)) {
        const auto node = found.find(node_number(fs::path(resolve(entry.path())).filename()));
        if (node != found.end()) node->second.links.push_back(entry.path());
      }
    }
    std::vector<VideoNode> sorted;
    for (auto& [number, node] : found) {
      std::sort(node.links.begin(), node.links.end(), [](const std::string& a, const std::string& b) {
        // by-path before by-id: it distinguishes two cameras of one model without serial numbers.
        return std::tuple(a.find("by-path") == a.npos, a) < std::tuple(b.find("by-path") == b.npos, b);
      });
      sorted.push_back(std::move(node));
    }
    std::stable_sort(sorted.begin(), sorted.end(), [](const VideoNode& a, const VideoNode& b) {
      const bool a_named = !a.links.empty(), b_named = !b.links.empty();
      if (a_named != b_named) return a_named;
      return a_named && a.links.front() < b.links.front();
    });
    return sorted;
  }

  std::string resolve(const std::string& name) override {
    std::error_code error;
    const fs::path node = fs::canonical(name, error);
    return error ? std::string() : node.string();
  }

  std::string camera_id(const std::string& node) override {
    // The USB interface that controls the function is the parent of all its nodes.
    const fs::path device = "/sys/class/video4linux/" + fs::path(node).filename().string() + "/device";
    std::error_code error;
    const fs::path subsystem = fs::canonical(device / "subsystem", error);
    if (error || subsystem.filename() != "usb") return node;
    const fs::path interface = fs::canonical(device, error);
    return error ? node : interface.string();
  }

  std::unique_ptr<Waiter> make_waiter() override { return std::make_unique<KernelWaiter>(); }

  int open(const std::string& node, bool convert) override {
    const int descriptor = ::open(node.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return -errno;
    if (!convert) return descriptor;
    const bool countable = static_cast<std::size_t>(descriptor) < converted_.size();
    if (!countable || v4l2_fd_open(descriptor, 0) < 0) {
      const int error = countable ? errno : EMFILE;
      ::close(descriptor);
      return -error;
    }
    converted_[static_cast<std::size_t>(descriptor)] = true;
    return descriptor;
  }

  void close(int descriptor) noexcept override {
    if (is_converted(descriptor)) {
      converted_[static_cast<std::size_t>(descriptor)] = false;
      v4l2_close(descriptor);
    } else {
      ::close(descriptor);
    }
  }

  int ioctl(int descriptor, unsigned long request, void* argument) noexcept override {
    int result = 0;
    do {
      result = is_converted(descriptor) ? v4l2_ioctl(descriptor, request, argument)
                                        : ::ioctl(descriptor, request, argument);
    } while (result < 0 && errno == EINTR);
    return result < 0 ? errno : 0;
  }

  void* map(int descriptor, std::size_t length, std::int64_t offset, int& error) noexcept override {
    // libv4l2 writes converted images into its mappings and requires both access rights.
    void* memory = is_converted(descriptor)
                       ? v4l2_mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, offset)
                       : mmap(nullptr, length, PROT_READ, MAP_SHARED, descriptor, offset);
    if (memory != MAP_FAILED) return memory;
    error = errno;
    return nullptr;
  }

  // libv4l2 recognizes its own mappings and passes the others on to the kernel.
  void unmap(void* memory, std::size_t length) noexcept override { v4l2_munmap(memory, length); }

  std::int64_t now_ns() noexcept override {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }

  void sleep_until(std::int64_t time_ns) noexcept override {
    const timespec until{static_cast<time_t>(time_ns / 1'000'000'000),
                         static_cast<long>(time_ns % 1'000'000'000)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
    }
  }

 private:
  // The descriptors that go through libv4l2. open() refuses a descriptor beyond the end.
  bool is_converted(int descriptor) const noexcept {
    const auto place = static_cast<std::size_t>(descriptor);
    return place < converted_.size() && converted_[place];
  }

  std::array<std::atomic<bool>, 1024> converted_{};
};

}  // namespace

std::unique_ptr<VideoSystem> make_kernel_video_system() { return std::make_unique<KernelVideoSystem>(); }

}  // namespace stereod::v4l2
