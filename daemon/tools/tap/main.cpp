// SPDX-License-Identifier: BSD-3-Clause
// stereo-tap: receives from stereod over LCM.
#include <CLI/CLI.hpp>
#include <exception>
#include <functional>
#include <string>

#include "daemon/base/stop_signals.h"
#include "daemon/lcm/url.h"
#include "daemon/tools/tap/tap.h"

namespace stereod::tools {
namespace {

constexpr const char* kExitStatuses =
    "Exit status: 0 success; 1 wrong usage, no network, or a file that cannot be written;\n"
    "2 nothing arrived; 3 rows or frames were lost.";

/// The options of all commands, and the command to run.
struct CommandLine {
  TapOptions tap;
  StatusOptions status;
  SaveOptions save;
  CheckOptions check;
  RecordOptions record;
  PlayOptions play;
  std::function<int(StopSignals&)> command;
};

void add_common_options(CLI::App& app, CommandLine& line) {
  app.add_option(
      "--lcm-url", line.tap.lcm_url,
      "LCM URL (default: LCM_DEFAULT_URL of the environment, else " + std::string(kDefaultLcmUrl) + ")");
  app.add_option("--prefix", line.tap.prefix, "prefix of the channels, lcm.prefix of the daemon")
      ->capture_default_str();
}

void add_status(CLI::App& app, CommandLine& line) {
  CLI::App* command =
      app.add_subcommand("status", "Shows the status of the daemon once a second, until Ctrl-C.");
  command->add_flag("--once", line.status.once, "print one status and exit");
  command->add_option("--timeout", line.status.timeout_s, "[s] longest wait with --once")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  command->callback([&line] {
    line.command = [&line](StopSignals& stop) { return run_status(line.tap, line.status, stop); };
  });
}

void add_save(CLI::App& app, CommandLine& line) {
  CLI::App* command = app.add_subcommand(
      "save", "Saves frames to files: measured disparities in px (.pfm) and in colors (.png).");
  command->add_option("--frames", line.save.frames, "number of frames")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--out", line.save.directory, "directory for the files; created if missing")
      ->required();
  command->add_option("--timeout", line.save.timeout_s, "[s] longest wait for the next frame")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  command->callback(
      [&line] { line.command = [&line](StopSignals& stop) { return run_save(line.tap, line.save, stop); }; });
}

void add_check(CLI::App& app, CommandLine& line) {
  CLI::App* command =
      app.add_subcommand("check", "Counts received and lost frames and rows, and measures the latency.");
  command->add_option("--seconds", line.check.seconds, "[s] duration")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  command->footer(
      "Frames that are incomplete at the start or the end are not counted. The latency up to this\n"
      "program is valid only on the daemon's machine or with synchronized clocks.\n\n" +
      std::string(kExitStatuses));
  command->callback([&line] {
    line.command = [&line](StopSignals& stop) { return run_check(line.tap, line.check, stop); };
  });
}

void add_record(CLI::App& app, CommandLine& line) {
  CLI::App* command =
      app.add_subcommand("record", "Records all channels of the daemon to an LCM log and prints a summary.");
  command->add_option("file", line.record.file, "LCM log; replaced if it exists")->required();
  command->add_option("--seconds", line.record.seconds, "[s] duration; 0: until Ctrl-C")
      ->check(CLI::Range(0.0, 1e8))
      ->capture_default_str();
  command->callback([&line] {
    line.command = [&line](StopSignals& stop) { return run_record(line.tap, line.record, stop); };
  });
}

void add_play(CLI::App& app, CommandLine& line) {
  CLI::App* command = app.add_subcommand(
      "play", "Publishes the messages of an LCM log at their recorded pace and prints a summary.");
  command->add_option("file", line.play.file, "LCM log")->required();
  command->add_option("--speed", line.play.speed, "speed factor; 2: twice as fast")
      ->check(CLI::Range(0.001, 1000.0))
      ->capture_default_str();
  command->add_flag("--list", line.play.list_only, "print the summary, publish nothing");
  command->callback(
      [&line] { line.command = [&line](StopSignals& stop) { return run_play(line.tap, line.play, stop); }; });
}

int run(int argc, char** argv) {
  CommandLine line;
  CLI::App app(
      "Receives from stereod over LCM: shows its status, saves disparities, checks for losses, records and plays logs.",
      "stereo-tap");
  app.footer(kExitStatuses);
  app.require_subcommand(1);
  app.fallthrough();  // common options may follow the command
  add_common_options(app, line);
  add_status(app, line);
  add_save(app, line);
  add_check(app, line);
  add_record(app, line);
  add_play(app, line);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    print_error(std::string(error.what()) + " (see stereo-tap --help)");
    return kFailed;
  }
  StopSignals stop;
  return line.command(stop);
}

}  // namespace
}  // namespace stereod::tools

int main(int argc, char** argv) {
  try {
    return stereod::tools::run(argc, argv);
  } catch (const std::exception& error) {
    stereod::tools::print_error(error.what());
    return stereod::tools::kFailed;
  }
}
