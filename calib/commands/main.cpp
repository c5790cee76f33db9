// SPDX-License-Identifier: BSD-3-Clause
// stereo-calibrate: computes and checks the calibration of a stereo camera.
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

namespace stereod::calib {

namespace {

int fail(int status, std::string sentence) {
  std::replace(sentence.begin(), sentence.end(), '\n', ' ');
  std::fprintf(stderr, "stereo-calibrate: %s\n", sentence.c_str());
  return status;
}

// OpenCV reports errors as exceptions; its own messages would repeat them on stderr.
void silence_opencv() {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  cv::redirectError([](int, const char*, const char*, const char*, int, void*) { return 0; });
}

int run(int argc, char** argv) {
  silence_opencv();
  int status = kExitGood;
  CLI::App app("stereo-calibrate: calibrates a stereo camera for stereod", "stereo-calibrate");
  app.require_subcommand(1);
  app.footer("Exit status: 0 success, 1 the result should not be used, 2 invalid input, 3 system error.");
  add_board_command(app, status);
  add_capture_command(app, status);
  add_solve_command(app, status);
  add_check_command(app, status);
  add_interop_commands(app, status);
  try {
    app.parse(argc, argv);
    return status;
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::CallForAllHelp& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    return fail(kExitBadInput, std::string(error.what()) + "; see --help");
  } catch (const UsageError& error) {
    return fail(kExitBadInput, error.what());
  } catch (const FileError& error) {
    return fail(kExitBadInput, error.what());
  } catch (const CalibrationError& error) {
    return fail(kExitBadInput, error.what());
  } catch (const BusError& error) {
    return fail(error.permanent() ? kExitBadInput : kExitFailure, error.what());
  } catch (const std::exception& error) {
    return fail(kExitFailure, error.what());
  }
}

}  // namespace

}  // namespace stereod::calib

int main(int argc, char** argv) {
  try {
    return stereod::calib::run(argc, argv);
  } catch (...) {
    std::fputs("stereo-calibrate: unexpected error\n", stderr);
    return stereod::calib::kExitFailure;
  }
}
