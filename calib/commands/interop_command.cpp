// SPDX-License-Identifier: BSD-3-Clause
#include <charconv>
#include <cstdio>
#include <memory>
#include <vector>

#include "calib/base/errors.h"
#include "calib/board/board.h"
#include "calib/commands/commands.h"
#include "calib/interop/interop.h"
#include "daemon/base/file.h"
#include "daemon/config/calibration_file.h"

namespace stereod::calib {

namespace {

namespace fs = std::filesystem;

struct ImportFlags {
  std::vector<fs::path> ros, opencv;
  fs::path kalibr, output = "calibration.yaml";
  std::string image_size, unit;
  bool fisheye = false;
};

struct ExportFlags {
  fs::path calibration;
  std::vector<fs::path> ros, opencv;
};

Size parse_size(const std::string& text) {
  Size size;
  const char* const end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.width);
  if (width.ec == std::errc() && width.ptr != end && *width.ptr == 'x') {
    const auto height = std::from_chars(width.ptr + 1, end, size.height);
    const auto fits = [](int side) { return side >= 1 && side <= kMaxImageFileSide; };
    if (height.ec == std::errc() && height.ptr == end && fits(size.width) && fits(size.height)) return size;
  }
  throw UsageError("--image-size: found '" + text + "', allowed is WIDTHxHEIGHT in pixels, like 640x480");
}

Calibration imported(const ImportFlags& flags) {
  const int ways =
      (flags.ros.empty() ? 0 : 1) + (flags.opencv.empty() ? 0 : 1) + (flags.kalibr.empty() ? 0 : 1);
  if (ways != 1) throw UsageError("give exactly one file format: --ros, --opencv or --kalibr");
  if (flags.opencv.empty() && (!flags.image_size.empty() || !flags.unit.empty() || flags.fisheye)) {
    throw UsageError(
        "--image-size, --unit and --fisheye apply to --opencv only; the other formats contain these values");
  }
  if (!flags.ros.empty()) return read_ros(flags.ros[0], flags.ros[1]);
  if (!flags.kalibr.empty()) return read_kalibr(flags.kalibr);
  OpenCvHints hints;
  if (!flags.image_size.empty()) hints.image = parse_size(flags.image_size);
  if (!flags.unit.empty()) hints.unit_m = parse_length(flags.unit, "--unit");
  hints.fisheye = flags.fisheye;
  return read_opencv(flags.opencv[0], flags.opencv[1], hints);
}

void add_import(CLI::App& app) {
  CLI::App* command = app.add_subcommand("import", "convert the calibration of another program");
  auto flags = std::make_shared<ImportFlags>();
  command->add_option("--ros", flags->ros, "camera_info YAML files of the left and the right camera")
      ->expected(2);
  command
      ->add_option("--opencv", flags->opencv,
                   "intrinsics and extrinsics files, as OpenCV's sample stereo_calib writes them")
      ->expected(2);
  command->add_option("--kalibr", flags->kalibr, "Kalibr camchain YAML file; cam0 is the left camera");
  command->add_option("--image-size", flags->image_size,
                      "with --opencv: WIDTHxHEIGHT, like 640x480, if the file lacks it");
  command->add_option("--unit", flags->unit,
                      "with --opencv: length of 1 in the files, like 25mm if the side of a square was 1; "
                      "default 1m");
  command->add_flag("--fisheye", flags->fisheye, "with --opencv: the files use the fisheye model");
  command->add_option("-o,--output", flags->output, "calibration file for stereod")->capture_default_str();
  command->callback([flags] {
    std::vector<fs::path> read{flags->kalibr};
    read.insert(read.end(), flags->ros.begin(), flags->ros.end());
    read.insert(read.end(), flags->opencv.begin(), flags->opencv.end());
    require_distinct({flags->output}, read);
    const Calibration calibration = imported(*flags);
    write_calibration(flags->output, calibration);
    std::printf("%s: image size %d×%d px, focal length %.1f px, baseline %.2f mm\n", flags->output.c_str(),
                calibration.image.width, calibration.image.height, calibration.left.projection.fx,
                1000 * calibration.baseline_m);
  });
}

void add_export(CLI::App& app) {
  CLI::App* command = app.add_subcommand("export", "convert a calibration for other programs");
  auto flags = std::make_shared<ExportFlags>();
  command->add_option("CALIBRATION", flags->calibration, "calibration.yaml")->required();
  command->add_option("--ros", flags->ros, "camera_info YAML files of the left and the right camera")
      ->expected(2);
  command
      ->add_option("--opencv", flags->opencv, "OpenCV intrinsics and extrinsics files, .yml, .xml or .json")
      ->expected(2);
  command->callback([flags] {
    if (flags->ros.empty() && flags->opencv.empty())
      throw UsageError("give an output format: --ros or --opencv");
    std::vector<fs::path> written = flags->ros;
    written.insert(written.end(), flags->opencv.begin(), flags->opencv.end());
    require_distinct(written, {flags->calibration});
    const Calibration calibration = read_calibration(flags->calibration);
    if (!flags->ros.empty()) write_ros(flags->ros[0], flags->ros[1], calibration);
    if (!flags->opencv.empty()) write_opencv(flags->opencv[0], flags->opencv[1], calibration);
  });
}

}  // namespace

void add_interop_commands(CLI::App& app, int&) {
  add_import(app);
  add_export(app);
}

}  // namespace stereod::calib
