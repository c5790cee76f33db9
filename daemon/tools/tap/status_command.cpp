// SPDX-License-Identifier: BSD-3-Clause
// stereo-tap status: shows the status in a terminal.
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <utility>

#include "daemon/base/stop_signals.h"
#include "daemon/lcm/message_decoder.h"
#include "daemon/lcm/receiver.h"
#include "daemon/tools/tap/status_table.h"
#include "daemon/tools/tap/tap.h"
#include "daemon/tools/tap/text_table.h"

namespace stereod::tools {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// Without a status for longer, the table says so. The daemon sends one a second.
constexpr double kMaxSilence_s = 2.5;

double seconds_since(Clock::time_point time) {
  return std::chrono::duration<double>(Clock::now() - time).count();
}

/// Prints tables: in a terminal each over the previous one, else one after the other.
class Screen {
 public:
  Screen() : is_terminal_(isatty(STDOUT_FILENO) != 0) {
    if (is_terminal_) std::fputs("\x1b[2J", stdout);
  }

  bool is_terminal() const { return is_terminal_; }

  void show(std::vector<std::string> lines) {
    if (!is_terminal_) {
      if (shown_) std::puts("");
      for (const std::string& line : lines) std::printf("%s\n", line.c_str());
    } else {
      // A table that does not fit loses its blank lines, then its last lines: the state stays visible.
      if (lines.size() > terminal_height()) std::erase(lines, "");
      const std::size_t height = std::min(terminal_height(), lines.size());
      std::fputs("\x1b[H", stdout);
      for (std::size_t i = 0; i < height; ++i) {
        std::printf("%s\x1b[K%s", lines[i].c_str(), i + 1 < height ? "\r\n" : "");
      }
      std::fputs("\x1b[J", stdout);
    }
    std::fflush(stdout);
    shown_ = true;
  }

  /// Moves the cursor below the table.
  void leave() {
    if (is_terminal_) std::puts("");
  }

 private:
  static std::size_t terminal_height() {
    winsize size{};
    return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > 0 ? size.ws_row : 24;
  }

  bool is_terminal_;
  bool shown_ = false;
};

/// The latest status and its arrival.
struct Latest {
  std::optional<status_t> status;
  Clock::time_point when = Clock::now();
  bool fresh = false;  // not shown yet
};

void listen(LcmReceiver& receiver, const TapOptions& tap, Latest& latest) {
  receiver.subscribe(tap.channel("STATUS"), [&latest](std::span<const std::byte> bytes) {
    status_t status;
    if (!decode_message(bytes, status)) return;
    latest.status = std::move(status);
    latest.when = Clock::now();
    latest.fresh = true;
  });
}

int show_once(const TapOptions& tap, LcmReceiver& receiver, const Latest& latest, double timeout_s,
              StopSignals& stop) {
  const Clock::time_point begin = Clock::now();
  while (!latest.status && seconds_since(begin) < timeout_s && !stop.arrived())
    receiver.receive(milliseconds(50));
  if (!latest.status) {
    print_error("no status on " + tap.channel("STATUS") + " within " + fixed(timeout_s, 1) + " s (" +
                receiver.url() + "); is stereod running?");
    return kNothingArrived;
  }
  for (const std::string& line : status_lines(*latest.status)) std::printf("%s\n", line.c_str());
  return kSuccess;
}

int show_live(const TapOptions& tap, LcmReceiver& receiver, Latest& latest, StopSignals& stop) {
  Screen screen;
  if (screen.is_terminal()) {
    screen.show({"waiting for " + tap.channel("STATUS") + " on " + receiver.url() + " (Ctrl-C ends)"});
  } else {
    print_error("waiting for " + tap.channel("STATUS") + " on " + receiver.url());
  }
  bool silent = false;
  while (!stop.arrived()) {
    receiver.receive(milliseconds(100));
    if (!latest.status) continue;
    const bool now_silent = seconds_since(latest.when) > kMaxSilence_s;
    if (!latest.fresh && !(now_silent && (screen.is_terminal() || !silent))) continue;
    silent = now_silent;
    std::vector<std::string> lines = status_lines(*latest.status);
    if (silent) {
      const std::string age = duration_in_words(seconds_since(latest.when));
      lines.insert(lines.begin(), "NO STATUS FOR " + age + "; the last status was:");
    }
    screen.show(std::move(lines));
    latest.fresh = false;
  }
  screen.leave();
  return kSuccess;
}

}  // namespace

int run_status(const TapOptions& tap, const StatusOptions& options, StopSignals& stop) {
  LcmReceiver receiver(tap.lcm_url);
  Latest latest;
  listen(receiver, tap, latest);
  if (options.once) return show_once(tap, receiver, latest, options.timeout_s, stop);
  return show_live(tap, receiver, latest, stop);
}

}  // namespace stereod::tools
