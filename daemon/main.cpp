// SPDX-License-Identifier: BSD-3-Clause
// stereod: the daemon.
#include <signal.h>
#include <spdlog/spdlog.h>
#include <time.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>

#include "daemon/base/clocks.h"
#include "daemon/base/file_error.h"
#include "daemon/capture/v4l2/camera_list.h"
#include "daemon/config/config.h"
#include "daemon/lcm/bus.h"
#include "daemon/service/checks.h"
#include "daemon/service/log.h"
#include "daemon/service/service.h"
#include "daemon/service/version.h"

namespace stereod {
namespace {

constexpr int kExitRetry = 1;    // a later start may succeed; systemd starts the daemon again
constexpr int kExitConfig = 78;  // EX_CONFIG of sysexits.h: this configuration can never work

// Blocks the signals that wait_for_signal() takes. Threads started later inherit the mask.
sigset_t blocked_stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  // The reader of stderr may exit before the daemon.
  ::signal(SIGPIPE, SIG_IGN);
  return signals;
}

// Waits for a signal until the given time. Returns the signal's number, or 0.
int wait_for_signal(const sigset_t& signals, std::int64_t until_ns) {
  const std::int64_t left_ns = until_ns - monotonic_ns();
  const std::int64_t wait_ns = left_ns > 0 ? left_ns : 0;
  const timespec wait{static_cast<time_t>(wait_ns / 1'000'000'000),
                      static_cast<long>(wait_ns % 1'000'000'000)};
  const int signal = sigtimedwait(&signals, nullptr, &wait);
  return signal > 0 ? signal : 0;
}

// Returns when a signal asks to stop or a recording has ended.
void serve(Service& service, const sigset_t& signals) {
  constexpr std::int64_t kTick_ns = 50'000'000;
  while (true) {
    service.tick();
    if (service.finished()) {
      spdlog::info("end of the recording, shutting down");
      return;
    }
    const int signal = wait_for_signal(signals, monotonic_ns() + kTick_ns);
    if (signal == SIGHUP) {
      service.reload();
    } else if (signal != 0) {
      spdlog::info("received {}, shutting down", signal == SIGINT ? "SIGINT" : "SIGTERM");
      return;
    }
  }
}

void run(const Config& config, const std::filesystem::path& file) {
  const sigset_t signals = blocked_stop_signals();
  Service service(config, file, [](const std::string& url) { return std::make_unique<LcmBus>(url); });
  serve(service, signals);
  service.stop();
}

int fail(const std::string& message, int status) {
  spdlog::error("{}", message);
  return status;
}

int main_with(int argc, char** argv) {
  CLI::App app("stereod: publishes rectified disparities of two cameras on LCM.");
  std::string config_file = "/etc/stereod/stereod.yaml";
  bool check_only = false;
  app.add_option("--config", config_file, "configuration file")->capture_default_str();
  CLI::Option* check = app.add_flag("--check-config", check_only, "check the configuration and exit");
  bool list_only = false;
  app.add_flag("--list-cameras", list_only, "print the names, formats and controls of every camera and exit")
      ->excludes(check);
  app.set_version_flag("--version", std::string("stereod ") + kVersion);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitConfig;
  }
  set_up_log("info");
  try {
    if (list_only) {
      std::fputs(v4l2::list_cameras(*v4l2::make_kernel_video_system()).c_str(), stdout);
      return 0;
    }
    const Config config = read_config(config_file);
    set_up_log(config.log_level);
    if (check_only) {
      open_checked_source(config, config_file);
      std::printf("%s: OK\n", config_file.c_str());
    } else {
      run(config, config_file);
    }
    return 0;
  } catch (const BusError& error) {
    return fail(error.what(), error.permanent() ? kExitConfig : kExitRetry);
  } catch (const FileError& error) {
    return fail(error.what(), kExitConfig);
  } catch (const std::invalid_argument& error) {
    return fail(config_file + ": " + error.what(), kExitConfig);
  } catch (const std::exception& error) {
    return fail(std::string("unexpected error: ") + error.what(), kExitRetry);
  }
}

}  // namespace
}  // namespace stereod

int main(int argc, char** argv) {
  try {
    return stereod::main_with(argc, argv);
  } catch (...) {
    std::fputs("stereod: unexpected error\n", stderr);
    return stereod::kExitRetry;
  }
}
