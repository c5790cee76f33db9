// stereod: the daemon.
#include <signal.h>
#include <spdlog/spdlog.h>
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <utility>

#include "core/match/isa.h"
#include "daemon/capture/v4l2/camera_list.h"
#include "daemon/config/config.h"
#include "daemon/config/file_error.h"
#include "daemon/pipeline/clocks.h"
#include "daemon/pipeline/pipeline.h"
#include "daemon/publish/lcm_bus.h"
#include "daemon/publish/wire_limits.h"
#include "daemon/service/log.h"
#include "daemon/service/status_reporter.h"
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

void serve(Pipeline& pipeline, MessageBus& bus, const sigset_t& signals) {
  constexpr std::int64_t kReportPeriod = 1'000'000'000;
  constexpr std::int64_t kLook = 50'000'000;  // how soon the end of a recording is noticed
  StatusReporter reporter(pipeline, bus);
  std::int64_t next_report = monotonic_ns();
  while (true) {
    const std::int64_t now = monotonic_ns();
    if (now >= next_report) {
      reporter.report();
      next_report = std::max(next_report + kReportPeriod, now);
    }
    if (pipeline.finished()) {
      reporter.report();
      spdlog::info("the recording has played to its end; stopping");
      return;
    }
    const int signal = wait_for_signal(signals, std::min(next_report, now + kLook));
    if (signal == SIGHUP) {
      spdlog::warn("SIGHUP came, but the configuration is only read at the start; restart to read it again");
    } else if (signal != 0) {
      spdlog::info("{} came; stopping", signal == SIGINT ? "SIGINT" : "SIGTERM");
      return;
    }
  }
}

// Finds everything that can never work before it touches the network, which may only be late. Throws
// FileError.
Rig open_checked_rig(const Config& config, const std::filesystem::path& file) {
  try {
    url_to_publish(config.lcm.url);
  } catch (const BusError& error) {
    throw FileError(place_of(file, "lcm.url") + ": " + error.what());
  }
  try {
    resolve_isa(config.matcher.isa);
  } catch (const std::invalid_argument& error) {
    throw FileError(place_of(file, "matcher.isa") + ": " + error.what());
  }
  Rig rig = open_rig(config);
  if (config.scan.enabled && !rig.calibration) {
    throw FileError(
        place_of(file, "scan.enabled") +
        ": found true, but without a calibration no distance is known; give one, or allowed is false");
  }
  try {
    check_pipeline(config, rig.left->frame_size());
  } catch (const std::invalid_argument& error) {
    const Size size = rig.left->frame_size();
    const bool too_large = std::max(size.width, size.height) > kLargestImageSide;
    throw FileError(place_of(file, too_large ? "cameras" : "lcm.rows_per_message") + ": " + error.what());
  }
  return rig;
}

void run(const Config& config, const std::filesystem::path& file) {
  const sigset_t signals = blocked_stop_signals();
  Rig rig = open_checked_rig(config, file);
  const Size size = rig.left->frame_size();
  LcmBus bus(config.lcm.url);
  Pipeline pipeline(config, std::move(rig), bus);
  spdlog::info("stereod {}: {} at {}×{}, matcher {}, channels {}_*", kVersion, name_of(config.cameras.source),
               size.width, size.height, pipeline.matcher_description(), config.lcm.prefix);
  serve(pipeline, bus, signals);
  pipeline.stop();
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
  app.add_flag("--check-config", check_only, "say whether the configuration can work, and end");
  bool list_only = false;
  app.add_flag("--list-cameras", list_only,
               "print every camera with its names, formats and controls, and end");
  app.set_version_flag("--version", std::string("stereod ") + kVersion);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitConfig;
  }
  set_up_log("info");
  try {
    if (list_only) {
      std::fputs(list_cameras(*make_kernel_video_system()).c_str(), stdout);
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
