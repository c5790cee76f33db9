// SPDX-License-Identifier: BSD-3-Clause
// After how many seconds a running stereod reports that a camera has moved, and what the check costs. The
// daemon replays pairs of a rig; from one frame on the right images are shifted down by some rows.
//
//   calibration_loss_seconds SCENES CALIBRATION [ROWS]
//
// SCENES: a directory with left_NAME.png and right_NAME.png
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "daemon/imagefile/read_image.h"
#include "daemon/imagefile/write_image.h"
#include "daemon/lcm/message_decoder.h"
#include "daemon/lcm/receiver.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_directory.h"

namespace stereod {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUrl = "udpm://239.255.76.67:17671?ttl=0";
constexpr int kBefore_s = 22, kAfter_s = 12;

/// Writes the frames of kBefore_s + kAfter_s seconds for replay. In the last kAfter_s seconds the right
/// images are @p rows rows lower.
void write_frames(const fs::path& scenes, const fs::path& directory, int rows, int fps) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(scenes)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("left_")) names.push_back(name.substr(5));
  }
  if (names.empty()) throw std::runtime_error(scenes.string() + " has no left_NAME.png.");
  std::sort(names.begin(), names.end());
  fs::create_directories(directory / "frames");
  for (const std::string& name : names) {
    const GrayImage right = read_gray(scenes / ("right_" + name));
    GrayImage lower(right.size());
    for (int y = 0; y < lower.height(); ++y)
      std::copy_n(right.row(std::clamp(y - rows, 0, lower.height() - 1)), lower.width(), lower.row(y));
    write_png(directory / ("lower_" + name), lower.view());
  }
  for (int i = 0; i < (kBefore_s + kAfter_s) * fps; ++i) {
    const std::string number = std::to_string(100'000 + i) + ".png";
    const std::string& name = names[static_cast<std::size_t>(i) % names.size()];
    fs::create_symlink(scenes / ("left_" + name), directory / "frames" / ("left_" + number));
    fs::create_symlink(i < kBefore_s * fps ? scenes / ("right_" + name) : directory / ("lower_" + name),
                       directory / "frames" / ("right_" + number));
  }
}

void measure(const fs::path& scenes, const fs::path& calibration, int rows, int fps, const char* preset) {
  const TemporaryDirectory directory;
  write_frames(scenes, directory.path(), rows, fps);
  std::ofstream(directory / "stereod.yaml")
      << "cameras: {source: replay, fps: " << fps << ", replay: {directory: frames, loop: false}}\n"
      << "calibration: " << calibration.string() << "\nmatcher: {preset: " << preset << "}\n"
      << "lcm: {url: \"" << kUrl << "\", prefix: MOVED}\n";
  LcmReceiver receiver(kUrl);
  status_t status{};
  receiver.subscribe("MOVED_STATUS",
                     [&](std::span<const std::byte> bytes) { decode_message(bytes, status); });
  ChildProgram stereod(fs::path(STEREOD_BIN_DIR) / "stereod",
                       {"--config", (directory / "stereod.yaml").string()}, directory.path());
  double reported_s = -1, error_before = 0, points_before = 0, cost = 0;
  bool false_alarm = false;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(kBefore_s + kAfter_s + 20);
  while (status.left.frames < (kBefore_s + kAfter_s) * fps - 2 && reported_s < 0 &&
         std::chrono::steady_clock::now() < deadline) {
    if (!receiver.receive(std::chrono::milliseconds(100))) continue;
    const bool moved = status.left.frames > kBefore_s * fps;
    if (!moved) {
      error_before = status.epipolar_error_px;
      points_before = static_cast<double>(status.epipolar_points);
      cost = status.epipolar_probe_percent;
      false_alarm = false_alarm || status.reason.find("the cameras have moved") != std::string::npos;
    } else if (status.reason.find("the cameras have moved") != std::string::npos) {
      reported_s = static_cast<double>(status.left.frames) / fps - kBefore_s;
    }
  }
  stereod.send(SIGTERM);
  const ProgramRun run = stereod.wait();
  if (status.utime == 0) throw std::runtime_error("stereod sent no status: " + run.err);
  const std::string after = reported_s < 0 ? "not in 12 s" : std::to_string(reported_s).substr(0, 4) + " s";
  std::printf("| %d | %-7s | %-11s | %.2f px from %.0f points | %.1f %% | %s |\n", fps, preset, after.c_str(),
              error_before, points_before, cost, false_alarm ? "FALSE ALARM before" : "");
  std::fflush(stdout);
}

int run(int argc, char** argv) {
  if (argc < 3 || argc > 4) {
    std::fprintf(stderr, "usage: calibration_loss_seconds SCENES CALIBRATION [ROWS]\n");
    return 2;
  }
  const int rows = argc > 3 ? std::atoi(argv[3]) : 4;
  std::printf(
      "%d rows lower\n| fps | preset | reported after | before the move | cost | "
      "|\n|---|---|---|---|---|---|\n",
      rows);
  for (const int fps : {30, 15}) {
    for (const char* preset : {"robust", "fast"})
      measure(fs::absolute(argv[1]), fs::absolute(argv[2]), rows, fps, preset);
  }
  return 0;
}

}  // namespace
}  // namespace stereod

int main(int argc, char** argv) {
  try {
    return stereod::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "calibration_loss_seconds: %s\n", error.what());
    return 1;
  }
}
