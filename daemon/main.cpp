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

constexpr int kExitRetry = 1;    // something outside may get better: systemd may start it again
constexpr int kExitConfig = 78;  // sysexits(3) EX_CONFIG: it will never work like this

// Signals are not handled but waited for; every thread inherits the mask.
sigset_t blocked_stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  // Whoever read the log may go away; that is no reason to stop.
  ::signal(SIGPIPE, SIG_IGN);
  return signals;
}

// Waits until a signal comes or the time has come; the signal's number, or 0.
int wait_for_signal(const sigset_t& signals, std::int64_t until_ns) {
  const std::int64_t left_ns = until_ns - monotonic_ns();
  const std::int64_t wait_ns = left_ns > 0 ? left_ns : 0;
  const timespec wait{static_cast<time_t>(wait_ns / 1'000'000'000),
                      static_cast<long>(wait_ns % 1'000'000'000)};
  const int signal = sigtimedwait(&signals, nullptr, &wait);
  return signal > 0 ? signal : 0;
}

// Until a signal ends it or there is nothing left to play.
void serve(Service& service, const sigset_t& signals) {
  constexpr std::int64_t kLook = 50'000'000;  // how soon the end of a recording is noticed
  while (true) {
    service.tick();
    if (service.finished()) {
      spdlog::info("the recording has played to its end; stopping");
      return;
    }
    const int signal = wait_for_signal(signals, monotonic_ns() + kLook);
    if (signal == SIGHUP) {
      service.reload();
    } else if (signal != 0) {
      spdlog::info("{} came; stopping", signal == SIGINT ? "SIGINT" : "SIGTERM");
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

int complain(const std::string& sentence, int status) {
  spdlog::error("{}", sentence);
  return status;
}

int main_with(int argc, char** argv) {
  CLI::App app("stereod: rectified disparity from two cameras, published on LCM.");
  std::string config_file = "/etc/stereod/stereod.yaml";
  bool check_only = false;
  app.add_option("--config", config_file, "the configuration")->capture_default_str();
  CLI::Option* check =
      app.add_flag("--check-config", check_only, "say whether the configuration can work, and end");
  bool list_only = false;
  app.add_flag("--list-cameras", list_only,
               "print every camera with its names, formats and controls, and end")
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
      open_checked_rig(config, config_file);
      std::printf("%s: nothing wrong with it\n", config_file.c_str());
    } else {
      run(config, config_file);
    }
    return 0;
  } catch (const BusError& error) {
    return complain(error.what(), error.permanent() ? kExitConfig : kExitRetry);
  } catch (const FileError& error) {
    return complain(error.what(), kExitConfig);
  } catch (const std::invalid_argument& error) {
    return complain(config_file + ": " + error.what(), kExitConfig);
  } catch (const std::exception& error) {
    return complain(std::string("stopped by an unexpected error: ") + error.what(), kExitRetry);
  }
}

}  // namespace
}  // namespace stereod

int main(int argc, char** argv) {
  try {
    return stereod::main_with(argc, argv);
  } catch (...) {
    std::fputs("stereod: stopped by an unexpected error\n", stderr);
    return stereod::kExitRetry;
  }
}
