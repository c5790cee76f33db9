// SPDX-License-Identifier: BSD-3-Clause
// uvcsim: a USB webcam in software, plugged into the virtual USB controller.
#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

#include "tests/vm/uvcsim/webcam.h"

namespace stereod::uvcsim {
namespace {

std::int64_t monotonic_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

// A named pipe for commands, one a line.
class CommandPipe {
 public:
  explicit CommandPipe(const std::string& path) {
    ::unlink(path.c_str());
    // Opened for reading and writing, so that it does not end when a writer closes it.
    if (::mkfifo(path.c_str(), 0600) != 0 ||
        (file_ = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)) < 0) {
      throw std::runtime_error(path + ": cannot be created");
    }
  }
  ~CommandPipe() { ::close(file_); }
  CommandPipe(const CommandPipe&) = delete;
  CommandPipe& operator=(const CommandPipe&) = delete;

  int descriptor() const { return file_; }

  /// Reads what is available and calls obey(line) for each complete line.
  template <typename Obey>
  void read_lines(Obey obey) {
    std::array<char, 256> bytes{};
    const ssize_t count = ::read(file_, bytes.data(), bytes.size());
    if (count > 0) text_.append(bytes.data(), static_cast<std::size_t>(count));
    for (std::size_t end = text_.find('\n'); end != std::string::npos; end = text_.find('\n')) {
      const std::string line = text_.substr(0, end);
      text_.erase(0, end + 1);
      obey(line);
    }
  }

 private:
  int file_ = -1;
  std::string text_;
};

// Blocks until a message of the host, a command, or the time of the next frame.
std::array<pollfd, 2> wait(const Webcam& webcam, const CommandPipe& pipe) {
  std::array<pollfd, 2> ready{{{webcam.descriptor(), POLLIN, 0}, {pipe.descriptor(), POLLIN, 0}}};
  timespec left{};
  const auto due = webcam.due_ns();
  if (due) {
    const std::int64_t ns = std::max<std::int64_t>(*due - monotonic_ns(), 0);
    left = {static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
  }
  ::ppoll(ready.data(), ready.size(), due ? &left : nullptr, nullptr);
  return ready;
}

void serve(Webcam& webcam, CommandPipe& pipe) {
  bool going = true;
  while (going) {
    const std::array<pollfd, 2> ready = wait(webcam, pipe);
    if (ready[0].revents != 0) webcam.handle(monotonic_ns());
    webcam.expose(monotonic_ns());
    if (ready[1].revents == 0) continue;
    pipe.read_lines([&](const std::string& line) {
      std::string complaint;
      const auto command = parse_command(line, complaint);
      if (!command) return static_cast<void>(std::fprintf(stderr, "uvcsim: %s\n", complaint.c_str()));
      if (!webcam.obey(*command)) going = false;
    });
  }
}

int main_with(int argc, char** argv) {
  CLI::App app("uvcsim: a USB webcam in software, on the virtual USB controller (vhci-hcd).");
  WebcamOptions options;
  std::string control;
  bool right = false;
  app.add_option("--port", options.port, "port of the virtual controller")->check(CLI::Range(0, 7));
  app.add_option("--serial", options.serial, "serial number of the camera");
  app.add_flag("--right", right, "show the right view");
  app.add_option("--control", control, "named pipe for commands; created at start")->required();
  CLI11_PARSE(app, argc, argv);
  if (right) options.eye = Eye::kRight;
  CommandPipe pipe(control);
  Webcam webcam(options);
  serve(webcam, pipe);
  return 0;
}

}  // namespace
}  // namespace stereod::uvcsim

int main(int argc, char** argv) {
  try {
    return stereod::uvcsim::main_with(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "uvcsim: %s\n", error.what());
    return 1;
  }
}
