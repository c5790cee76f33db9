// SPDX-License-Identifier: BSD-3-Clause
// stereo-match as a user runs it.
#include <gtest/gtest.h>
#include <regex.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/geometry/calibration.h"
#include "daemon/config/calibration_file.h"
#include "daemon/imagefile/pfm_file.h"
#include "daemon/imagefile/read_image.h"
#include "daemon/imagefile/write_image.h"
#include "tests/support/image_files.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_directory.h"

namespace stereod {
namespace {

constexpr Size kSize{160, 120};
constexpr int kTrueDisparity = 7;

/// Returns whether a POSIX extended regular expression matches a part of the text.
bool contains(const std::string& text, const char* pattern) {
  regex_t compiled;
  if (::regcomp(&compiled, pattern, REG_EXTENDED | REG_NOSUB) != 0) return false;
  const bool found = ::regexec(&compiled, text.c_str(), 0, nullptr, 0) == 0;
  ::regfree(&compiled);
  return found;
}

CameraCalibration pinhole(Size size) {
  CameraCalibration camera;
  camera.camera.image = size;
  camera.camera.fx = camera.camera.fy = 100;
  camera.camera.cx = (size.width - 1) / 2.0;
  camera.camera.cy = (size.height - 1) / 2.0;
  camera.projection = {100, 100, camera.camera.cx, camera.camera.cy};
  return camera;
}

class StereoMatch : public testing::Test {
 protected:
  StereoMatch() {
    write_pair(kSize);
    // Ground truth: 7 px × 16 everywhere; unknown in the left columns, whose partners lie outside the right image.
    GrayImage truth(kSize);
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 20; x < kSize.width; ++x) truth.at(x, y) = 16 * kTrueDisparity;
    }
    write_png(directory_ / "truth.png", truth.view());
  }

  /// Writes a plane of random gray values at kTrueDisparity.
  void write_pair(Size size) {
    const std::vector<int> texture = some_samples((size.width + kTrueDisparity) * size.height, 255);
    GrayImage left(size);
    GrayImage right(size);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const int row = y * (size.width + kTrueDisparity);
        left.at(x, y) = static_cast<std::uint8_t>(texture[static_cast<std::size_t>(row + x)]);
        right.at(x, y) =
            static_cast<std::uint8_t>(texture[static_cast<std::size_t>(row + x + kTrueDisparity)]);
      }
    }
    write_png(directory_ / "left.png", left.view());
    write_png(directory_ / "right.png", right.view());
  }

  std::string file(const std::string& name) const { return (directory_ / name).string(); }

  ProgramRun match(const std::vector<std::string>& arguments) const {
    return run_program(std::filesystem::path(STEREOD_BIN_DIR) / "stereo-match", arguments, directory_.path());
  }
  /// Runs stereo-match with the pair and more arguments.
  ProgramRun match_pair(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {file("left.png"), file("right.png")});
    return match(arguments);
  }

  /// Expects exit status 2, nothing on stdout, and one line on stderr with all @p parts.
  static void expect_refused(const ProgramRun& run, const std::vector<std::string>& parts) {
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(run.err.rfind("stereo-match: ", 0), 0U) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    for (const std::string& part : parts)
      EXPECT_NE(run.err.find(part), std::string::npos) << part << "\nin: " << run.err;
  }

  static void expect_good(const ProgramRun& run) {
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(run.err, "");
  }

  TemporaryDirectory directory_;
};

TEST_F(StereoMatch, Output_BothFormats) {
  expect_good(match_pair({"-o", file("out.pfm"), "--disparities", "16"}));
  expect_good(match_pair({"-o", file("out.png"), "--disparities", "16"}));
  const Image<float> pixels = read_pfm(directory_ / "out.pfm");
  const Image<std::uint16_t> kitti = read_gray16(directory_ / "out.png");
  ASSERT_EQ(pixels.size(), kSize);
  ASSERT_EQ(kitti.size(), kSize);
  EXPECT_NEAR(pixels.at(90, 60), kTrueDisparity, 0.1);
  EXPECT_NEAR(kitti.at(90, 60), 256 * kTrueDisparity, 26);
  EXPECT_TRUE(std::isinf(pixels.at(0, 0))) << "no window there";
  EXPECT_EQ(kitti.at(0, 0), 0);
}

TEST_F(StereoMatch, Implementations_WriteTheSame) {
  const std::vector<std::string> common{"--preset", "thesis", "--disparities", "16", "--window", "9"};
  std::vector<Bytes> results;
  for (const char* implementation : {"naive", "sliding", "simd"}) {
    for (const char* threads : {"1", "3"}) {
      std::vector<std::string> arguments = common;
      arguments.insert(arguments.end(),
                       {"--implementation", implementation, "--threads", threads, "-o", file("out.pfm")});
      expect_good(match_pair(arguments));
      results.push_back(bytes_in(directory_ / "out.pfm"));
    }
  }
  for (const Bytes& result : results) EXPECT_EQ(result, results.front());
}

TEST_F(StereoMatch, GroundTruth_Compared) {
  const ProgramRun run = match_pair(
      {"--preset", "thesis", "--disparities", "16", "--ground-truth", file("truth.png"), "--gt-scale", "16"});
  expect_good(run);
  EXPECT_NE(run.out.find("against " + file("truth.png")), std::string::npos) << run.out;
  EXPECT_TRUE(contains(run.out, "pixels +16800 +[0-9]+")) << run.out;
  EXPECT_TRUE(contains(run.out, "off by more than 1 px +[0-9]+[.][0-9][0-9] % +0[.]00 %")) << run.out;
  EXPECT_TRUE(contains(run.out, "mean absolute error +0[.][0-9][0-9][0-9] px")) << run.out;
}

// The files do not mark filled pixels, so the program prints their number and evaluates with and without them.
TEST_F(StereoMatch, HoleFilling_ReportsMeasuredAndFilled) {
  const std::vector<std::string> common{"--preset", "dense",       "--disparities",  "16",
                                        "-o",       file("o.pfm"), "--ground-truth", file("left.png")};
  const ProgramRun filled = match_pair(common);
  expect_good(filled);
  EXPECT_TRUE(contains(filled.out, "left.png, measured pixels only\n")) << filled.out;
  EXPECT_TRUE(contains(filled.out, "left.png, measured and filled pixels\n")) << filled.out;
  EXPECT_TRUE(contains(filled.out, "measured: [0-9.]+ % of the pixels; filled from neighbors: [0-9.]+ %"))
      << filled.out;
  const auto answered = [this] {
    const Image<float> pixels = read_pfm(directory_ / "o.pfm");
    long count = 0;
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) count += std::isfinite(pixels.at(x, y)) ? 1 : 0;
    }
    return count;
  };
  const long all = answered();
  EXPECT_EQ(all, static_cast<long>(kSize.width) * kSize.height);
  std::vector<std::string> without = common;
  without.emplace_back("--no-hole-filling");
  const ProgramRun sparse = match_pair(without);
  expect_good(sparse);
  EXPECT_FALSE(contains(sparse.out, "filled")) << sparse.out;
  EXPECT_LT(answered(), all);
}

TEST_F(StereoMatch, GroundTruthScale_Applied) {
  const ProgramRun run =
      match_pair({"--disparities", "16", "--ground-truth", file("truth.png"), "--gt-scale", "8"});
  expect_good(run);
  EXPECT_TRUE(contains(run.out, "off by more than 2 px +100[.]00 % +100[.]00 %")) << run.out;
}

TEST_F(StereoMatch, Repeat_MeasuresTime) {
  const ProgramRun run = match_pair({"--repeat", "3"});
  expect_good(run);
  EXPECT_TRUE(contains(run.out, "^median [0-9]+[.][0-9]+ ms, minimum [0-9]+[.][0-9]+ ms\n$")) << run.out;
}

TEST_F(StereoMatch, Color_WritesImage) {
  expect_good(match_pair({"--color", file("view.png")}));
  const ColorImage view = read_color(directory_ / "view.png");
  EXPECT_EQ(view.height(), kSize.height);
  EXPECT_GT(view.width(), kSize.width) << "the scale bar";
}

// The right camera is 10.5 rows off: bilinear gives the mean of two rows, nearest one of them; alpha 1 leaves a margin.
TEST_F(StereoMatch, RectificationOptions_Applied) {
  Calibration calibration;
  calibration.image = kSize;
  calibration.left = calibration.right = pinhole(kSize);
  calibration.right.camera.cy += 10.5;
  calibration.baseline_m = 0.07;
  write_calibration(directory_ / "rig.yaml", calibration);
  const auto rectified = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{"--calibration", file("rig.yaml"), "--rectified", file("l.png"),
                                       file("r.png")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_good(match_pair(arguments));
    return read_gray(directory_ / "r.png");
  };
  std::ofstream(directory_ / "stereod.yaml")
      << "cameras: {source: synthetic}\nrectify: {interpolation: nearest}\n";
  const GrayImage source = read_gray(directory_ / "right.png");
  const GrayImage bilinear = rectified({});
  const GrayImage nearest = rectified({"--interpolation", "nearest"});
  const GrayImage configured = rectified({"--config", file("stereod.yaml")});
  const GrayImage with_alpha = rectified({"--alpha", "1"});
  for (int y = 0; y + 12 < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const int above = source.at(x, y + 10), below = source.at(x, y + 11);
      ASSERT_TRUE(nearest.at(x, y) == above || nearest.at(x, y) == below);
      ASSERT_EQ(bilinear.at(x, y), (above + below + 1) / 2);
      ASSERT_EQ(configured.at(x, y), nearest.at(x, y));
    }
  }
  const std::uint8_t* last = with_alpha.row(kSize.height - 1);
  EXPECT_EQ(std::count(last, last + kSize.width, 0), kSize.width);
  expect_refused(match_pair({"--repeat", "1", "--interpolation", "bilinear"}), {"--calibration"});
  expect_refused(match_pair({"--repeat", "1", "--calibration", file("rig.yaml"), "--alpha", "2"}),
                 {"--alpha"});
  expect_refused(match_pair({"--repeat", "1", "--calibration", file("rig.yaml"), "--interpolation", "cubic"}),
                 {"bilinear, nearest"});
}

TEST_F(StereoMatch, Calibration_RectifiesFirst) {
  Calibration calibration;
  calibration.image = kSize;
  calibration.left = pinhole(kSize);
  calibration.right = pinhole(kSize);
  calibration.right.camera.cy += 3;  // the right camera looks 3 rows too high
  calibration.baseline_m = 0.07;
  write_calibration(directory_ / "rig.yaml", calibration);
  expect_good(match_pair({"--calibration", file("rig.yaml"), "--rectified", file("l.png"), file("r.png"),
                          "--color", file("view.png")}));
  const GrayImage right = read_gray(directory_ / "right.png");
  const GrayImage rectified = read_gray(directory_ / "r.png");
  const GrayImage left = read_gray(directory_ / "left.png");
  const GrayImage rectified_left = read_gray(directory_ / "l.png");
  for (int y = 0; y < kSize.height - 3; ++y) {
    EXPECT_TRUE(std::equal(left.row(y), left.row(y) + kSize.width, rectified_left.row(y))) << y;
    EXPECT_TRUE(std::equal(right.row(y + 3), right.row(y + 3) + kSize.width, rectified.row(y))) << y;
  }
}

TEST_F(StereoMatch, Precedence_FlagsPresetConfig) {
  // 5 disparities exclude the true one, 7.
  write_bytes(directory_ / "stereod.yaml",
              bytes_of("cameras: {source: synthetic}\nmatcher: {disparities: 5}\n"));
  const auto middle = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"-o", file("out.pfm"), "--config", file("stereod.yaml")});
    expect_good(match_pair(arguments));
    return read_pfm(directory_ / "out.pfm").at(90, 60);
  };
  EXPECT_FALSE(std::abs(middle({}) - kTrueDisparity) < 1);
  EXPECT_NEAR(middle({"--disparities", "9"}), kTrueDisparity, 0.1);
  EXPECT_NEAR(middle({"--preset", "fast"}), kTrueDisparity, 0.1);
  EXPECT_FALSE(std::abs(middle({"--preset", "fast", "--disparities", "4"}) - kTrueDisparity) < 1);
  EXPECT_NEAR(middle({"--disparities", "4", "--min-disparity", "6"}), kTrueDisparity, 0.1);
}

TEST_F(StereoMatch, Help_Printed) {
  const ProgramRun run = match({"--help"});
  expect_good(run);
  for (const char* flag : {"LEFT", "--output", "--preset", "--calibration", "--ground-truth", "--repeat"}) {
    EXPECT_NE(run.out.find(flag), std::string::npos) << flag;
  }
}

TEST_F(StereoMatch, WrongUsage_Refused) {
  expect_refused(match({}), {"LEFT is required", "--help"});
  expect_refused(match({file("left.png")}), {"RIGHT is required"});
  expect_refused(match_pair({}), {"nothing to do; give -o, --color"});
  expect_refused(match_pair({"--nonsense"}), {"--nonsense"});
  expect_refused(match_pair({"--repeat", "many"}), {"--repeat", "many"});
  expect_refused(match_pair({"--repeat", "0"}), {"--repeat: found 0, allowed 1…1000000"});
  expect_refused(match_pair({"--repeat", "1", "--threads", "0"}), {"--threads: found 0, allowed 1…256"});
  expect_refused(match_pair({"--repeat", "1", "--preset", "best"}),
                 {"--preset: found 'best'", "robust, dense, fine, fast, thesis"});
  expect_refused(match_pair({"--repeat", "1", "--cost", "ncc"}), {"--cost: found 'ncc'", "sad, ssd, mad"});
  expect_refused(match_pair({"--repeat", "1", "--isa", "mmx"}), {"--isa: found 'mmx'", "avx2"});
  expect_refused(match_pair({"--repeat", "1", "--implementation", "gpu"}),
                 {"--implementation: found 'gpu'", "simd"});
  expect_refused(match_pair({"--repeat", "1", "--gt-scale", "4"}), {"--gt-scale"});
  expect_refused(match_pair({"--ground-truth", file("truth.png"), "--gt-scale", "0"}), {"--gt-scale"});
}

TEST_F(StereoMatch, InvalidMatcherOptions_Refused) {
  const auto refused = [&](std::vector<std::string> arguments, const std::vector<std::string>& parts) {
    arguments.insert(arguments.end(), {"--repeat", "1"});
    expect_refused(match_pair(arguments), parts);
  };
  refused({"--method", "block", "--window", "4"}, {"window", "4"});
  refused({"--method", "block", "--window", "33"}, {"window", "33"});
  refused({"--disparities", "0"}, {"disparities", "0"});
  refused({"--disparities", "257"}, {"disparities", "257"});
  refused({"--min-disparity", "-1"}, {"--min-disparity", "-1"});
  refused({"--method", "block", "--cost", "ssd", "--implementation", "simd"}, {"cost"});
  refused({"--window", "9"}, {"--window", "--method block", "semiglobal"});
  refused({"--preset", "fast", "--p2", "9"}, {"--p2", "--method semiglobal", "block"});
  refused({"--preset", "fast", "--hole-filling"}, {"--hole-filling", "--method semiglobal"});
  refused({"--preset", "fast", "--census-weight", "3"}, {"--census-weight", "--method semiglobal"});
  refused({"--census-weight", "17"}, {"--census-weight: found 17", "0…16"});
  refused({"--gradient-limit", "65"}, {"--gradient-limit: found 65", "0…64"});
  refused({"--preset", "dense", "--method", "block"}, {"--hole-filling: found true", "--no-hole-filling"});
  refused({"--hole-filling", "--no-hole-filling"}, {"--hole-filling excludes --no-hole-filling"});
  refused({"--method", "census"}, {"--method: found 'census'", "block, semiglobal"});
}

TEST_F(StereoMatch, BadImages_Refused) {
  const auto refused = [&](const std::string& left, const std::string& right,
                           const std::vector<std::string>& parts) {
    expect_refused(match({left, right, "-o", file("out.pfm")}), parts);
    EXPECT_FALSE(std::filesystem::exists(directory_ / "out.pfm"));
  };
  refused(file("none.png"), file("right.png"), {file("none.png") + ": the file does not exist"});
  refused(file("left.png"), file("none.png"), {file("none.png") + ": the file does not exist"});
  refused(file("left.png"), directory_.path().string(), {directory_.path().string() + ": is a directory"});
  write_bytes(directory_ / "empty.png", {});
  refused(file("empty.png"), file("right.png"), {file("empty.png") + ": the file is empty"});
  write_bytes(directory_ / "text.png", bytes_of("not an image"));
  refused(file("text.png"), file("right.png"), {file("text.png") + ": is not an image in a known format"});
  Bytes half = bytes_in(directory_ / "right.png");
  half.resize(half.size() / 2);
  write_bytes(directory_ / "half.png", half);
  refused(file("left.png"), file("half.png"), {file("half.png") + ": the PNG file is truncated"});
  write_png(directory_ / "small.png", GrayImage(150, 120).view());
  refused(file("left.png"), file("small.png"),
          {file("small.png") + ": has 150×120 pixels", file("left.png") + " has 160×120"});
}

TEST_F(StereoMatch, UnreadableImages_Refused) {
  if (::geteuid() == 0) {
    // Root may read every file, but the start of its own memory is unmapped.
    expect_refused(match({"/proc/self/mem", file("right.png"), "--repeat", "1"}),
                   {"/proc/self/mem: the file cannot be read ("});
    return;
  }
  std::filesystem::permissions(directory_ / "left.png", std::filesystem::perms::none);
  expect_refused(match_pair({"--repeat", "1"}),
                 {file("left.png") + ": the file cannot be read (Permission denied)"});
}

TEST_F(StereoMatch, UnwritableOutputs_Refused) {
  expect_refused(match_pair({"-o", file("out.tif")}),
                 {file("out.tif") + ": disparities are written to files named .pfm or .png"});
  expect_refused(match_pair({"-o", file("no/out.pfm")}),
                 {file("no/out.pfm") + ": the directory to write to does not exist"});
  expect_refused(match_pair({"--color", file("view.jpg")}), {file("view.jpg"), ".png"});
  expect_refused(match_pair({"--rectified", file("l.png"), file("r.bmp")}), {file("r.bmp"), ".png"});
}

TEST_F(StereoMatch, BadGroundTruth_Refused) {
  expect_refused(match_pair({"--ground-truth", file("none.png")}),
                 {file("none.png") + ": the file does not exist"});
  write_png(directory_ / "small.png", GrayImage(150, 120).view());
  expect_refused(match_pair({"--ground-truth", file("small.png")}),
                 {file("small.png") + ": has 150×120 pixels", file("left.png") + " has 160×120"});
}

TEST_F(StereoMatch, BadCalibrationOrConfig_Refused) {
  expect_refused(match_pair({"--repeat", "1", "--calibration", file("none.yaml")}), {file("none.yaml")});
  expect_refused(match_pair({"--repeat", "1", "--config", file("none.yaml")}), {file("none.yaml")});
  write_bytes(directory_ / "bad.yaml", bytes_of("cameras: {source: synthetic}\nmatcher: {windw: 5}\n"));
  expect_refused(match_pair({"--repeat", "1", "--config", file("bad.yaml")}),
                 {file("bad.yaml") + ":2", "windw"});

  Calibration calibration;
  calibration.image = {320, 240};
  calibration.left = calibration.right = pinhole(calibration.image);
  calibration.baseline_m = 0.07;
  write_calibration(directory_ / "rig.yaml", calibration);
  expect_refused(match_pair({"--repeat", "1", "--calibration", file("rig.yaml")}),
                 {file("rig.yaml") + ": is for 320×240 pixels", file("left.png") + " has 160×120"});
}

}  // namespace
}  // namespace stereod
