// stereo-tap: listens to stereod over LCM.
#include <CLI/CLI.hpp>
#include <exception>
#include <functional>
#include <string>

#include "daemon/base/stop_signals.h"
#include "daemon/lcm/url.h"
#include "daemon/tools/tap/tap.h"

namespace stereod {
namespace {

constexpr const char* kExitStatuses =
    "Exit status: 0 all well; 1 wrong usage, no network, or a file that cannot be written;\n"
    "2 nothing arrived; 3 something was lost.";

/// What the command line asks for.
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
  app.add_option("--lcm-url", line.tap.lcm_url,
                 "where to listen (default: the environment's LCM_DEFAULT_URL, else " +
                     std::string(kDefaultLcmUrl) + ")");
  app.add_option("--prefix", line.tap.prefix, "what the daemon's channels begin with")->capture_default_str();
}

void add_status(CLI::App& app, CommandLine& line) {
  CLI::App* command = app.add_subcommand("status", "How the daemon is, once a second, until Ctrl-C.");
  command->add_flag("--once", line.status.once, "print one status and end");
  command->add_option("--timeout", line.status.timeout_s, "how long --once waits, s")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  command->callback([&line] {
    line.command = [&line](StopSignals& stop) { return run_status(line.tap, line.status, stop); };
  });
}

void add_save(CLI::App& app, CommandLine& line) {
  CLI::App* command = app.add_subcommand(
      "save", "Writes frames into files: disparities in px (.pfm) and a image in colors (.png).");
  command->add_option("--frames", line.save.frames, "how many")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--out", line.save.directory, "the directory; made if it is not there")->required();
  command->add_option("--timeout", line.save.timeout_s, "how long to wait for the next frame, s")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  command->callback(
      [&line] { line.command = [&line](StopSignals& stop) { return run_save(line.tap, line.save, stop); }; });
}

void add_check(CLI::App& app, CommandLine& line) {
  CLI::App* command =
      app.add_subcommand("check", "Counts what arrives and what is lost, and measures how long it takes.");
  command->add_option("--seconds", line.check.seconds, "how long to listen")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  command->footer(
      "A frame that was under way when the listening began or ended is not counted. The time until a\n"
      "frame is here means something only on the daemon's machine, or with clocks that agree.\n\n" +
      std::string(kExitStatuses));
  command->callback([&line] {
    line.command = [&line](StopSignals& stop) { return run_check(line.tap, line.check, stop); };
  });
}

void add_record(CLI::App& app, CommandLine& line) {
  CLI::App* command = app.add_subcommand(
      "record", "Records all of the daemon's channels into an LCM log, and says what is in it.");
  command->add_option("file", line.record.file, "the log; replaced if it is there")->required();
  command->add_option("--seconds", line.record.seconds, "how long; 0: until Ctrl-C")
      ->check(CLI::Range(0.0, 1e8))
      ->capture_default_str();
  command->callback([&line] {
    line.command = [&line](StopSignals& stop) { return run_record(line.tap, line.record, stop); };
  });
}

void add_play(CLI::App& app, CommandLine& line) {
  CLI::App* command = app.add_subcommand(
      "play", "Publishes what is in an LCM log, at the pace of the log, and says what it was.");
  command->add_option("file", line.play.file, "the log")->required();
  command->add_option("--speed", line.play.speed, "2: twice as fast")
      ->check(CLI::Range(0.001, 1000.0))
      ->capture_default_str();
  command->add_flag("--list", line.play.list_only, "only say what is in it");
  command->callback(
      [&line] { line.command = [&line](StopSignals& stop) { return run_play(line.tap, line.play, stop); }; });
}

int run(int argc, char** argv) {
  CommandLine line;
  CLI::App app("Listens to stereod over LCM: shows its status, saves its disparities, checks what arrives.",
               "stereo-tap");
  app.footer(kExitStatuses);
  app.require_subcommand(1);
  app.fallthrough();  // the common options may follow the command
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
    complain(std::string(error.what()) + " (see stereo-tap --help)");
    return kFailed;
  }
  StopSignals stop;
  return line.command(stop);
}

}  // namespace
}  // namespace stereod

int main(int argc, char** argv) {
  try {
    return stereod::run(argc, argv);
  } catch (const std::exception& error) {
    stereod::complain(error.what());
    return stereod::kFailed;
  }
}
