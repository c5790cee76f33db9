// stereo-calibrate: from images of a chessboard to the daemon's calibration, and what surrounds it.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <opencv2/core/utility.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <string>

#include "calib/base/errors.h"
#include "calib/commands/commands.h"
#include "daemon/base/file_error.h"
#include "daemon/lcm/handle.h"

namespace {

int say(int status, std::string sentence) {
  std::replace(sentence.begin(), sentence.end(), '\n', ' ');
  std::fprintf(stderr, "stereo-calibrate: %s\n", sentence.c_str());
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  cv::redirectError([](int, const char*, const char*, const char*, int, void*) { return 0; });
  int status = stereod::kExitGood;
  CLI::App app("stereo-calibrate: calibrates a pair of cameras for stereod", "stereo-calibrate");
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 good, 1 the result should not be used, 2 wrong input, 3 failure of the machine.");
  stereod::add_board_command(app, status);
  stereod::add_capture_command(app, status);
  stereod::add_solve_command(app, status);
  stereod::add_check_command(app, status);
  stereod::add_exchange_commands(app, status);
  try {
    app.parse(argc, argv);
    return status;
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::CallForAllHelp& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    return say(stereod::kExitBadInput, std::string(error.what()) + "; see --help");
  } catch (const stereod::UsageError& error) {
    return say(stereod::kExitBadInput, error.what());
  } catch (const stereod::FileError& error) {
    return say(stereod::kExitBadInput, error.what());
  } catch (const stereod::CalibrationError& error) {
    return say(stereod::kExitBadInput, error.what());
  } catch (const stereod::BusError& error) {
    return say(error.permanent() ? stereod::kExitBadInput : stereod::kExitFailure, error.what());
  } catch (const std::exception& error) {
    return say(stereod::kExitFailure, error.what());
  }
}
