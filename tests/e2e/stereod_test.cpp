// SPDX-License-Identifier: BSD-3-Clause
// The daemon as a user runs it, and a receiver in another process.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <regex>
#include <string>
#include <vector>

#include "daemon/client/stereod_client.h"
#include "daemon/config/calibration_file.h"
#include "daemon/imagefile/pfm_file.h"
#include "daemon/imagefile/read_image.h"
#include "daemon/imagefile/write_image.h"
#include "daemon/lcm/message_decoder.h"
#include "daemon/lcm/receiver.h"
#include "daemon/tools/tap/frame_listener.h"
#include "tests/support/foreign_isa.h"
#include "tests/support/network.h"
#include "tests/support/recorded_pairs.h"
#include "tests/support/run_program.h"
#include "tests/support/sanitized.h"
#include "tests/support/temporary_directory.h"

namespace stereod {
namespace {

constexpr Size kSize{320, 240};
constexpr int kPairs = 4;
constexpr const char* kUrl = "udpm://239.255.76.67:17667?ttl=0";  // a port of the tests' own

const std::filesystem::path kBin = STEREOD_BIN_DIR;

class StereodTest : public testing::Test {
 protected:
  std::filesystem::path write_config(const std::string& matcher, const std::string& more = "") {
    const std::filesystem::path file = directory_ / "stereod.yaml";
    std::ofstream(file) << "cameras:\n  source: replay\n  fps: 10\n  replay: {directory: ., loop: true}\n"
                        << "calibration: calibration.yaml\n"
                        << "matcher: " << matcher << "\n"
                        << "lcm: {url: \"" << kUrl << "\", prefix: E2E}\n"
                        << more;
    return file;
  }

  ProgramRun run_stereod(const std::vector<std::string>& arguments) {
    return run_program(kBin / "stereod", arguments, directory_.path());
  }

  TemporaryDirectory directory_;
};

/// Returns the result of stereo-match for a recorded pair.
Image<float> matched_by_tool(const std::filesystem::path& directory, int number,
                             const std::vector<std::string>& options) {
  const std::filesystem::path out = directory / "expected.pfm";
  std::vector<std::string> arguments{recorded_left(directory, number).string(),
                                     recorded_right(directory, number).string(),
                                     "-o",
                                     out.string(),
                                     "--calibration",
                                     (directory / "calibration.yaml").string()};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const ProgramRun run = run_program(kBin / "stereo-match", arguments, directory);
  EXPECT_EQ(run.status, 0) << run.err;
  return read_pfm(out);
}

struct Setting {
  const char* name;
  const char* matcher;
  std::vector<std::string> options;
};

class StereodRows : public StereodTest, public testing::WithParamInterface<Setting> {};

TEST_P(StereodRows, OtherProcess_SameAsStereoMatch) {
  if (const auto why = why_no_multicast()) GTEST_SKIP() << *why;
  write_recorded_pairs(directory_.path(), kSize, kPairs);
  std::map<std::int64_t, Image<float>> expected;
  for (int i = 0; i < kPairs; ++i)
    expected.emplace(i, matched_by_tool(directory_.path(), i, GetParam().options));

  int frames = 0;
  long filled = 0;
  FrameAssembler assembler([&](StereoFrame&& frame) {
    ASSERT_TRUE(frame.complete()) << "frame " << frame.frame;
    ++frames;
    const Image<float>& want = expected.at(frame.summary->left_sequence % kPairs);
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        int units = frame.disparity.at(x, y);
        if (frame.filled.width() > 0 && frame.filled.at(x, y) != DisparityMap::kNone) {
          ASSERT_EQ(units, DisparityMap::kNone) << "measured and filled";
          units = frame.filled.at(x, y), ++filled;
        }
        const float got = units == DisparityMap::kNone
                              ? INFINITY
                              : static_cast<float>(units) / static_cast<float>(frame.units_per_pixel);
        ASSERT_EQ(got, want.at(x, y)) << "frame " << frame.frame << ", pixel (" << x << ", " << y << ")";
      }
    }
  });
  LcmReceiver receiver(kUrl);
  tools::TapOptions tap;
  tap.prefix = "E2E";
  tools::listen_for_frames(receiver, tap, assembler);
  ChildProgram stereod(kBin / "stereod", {"--config", write_config(GetParam().matcher).string()},
                       directory_.path());
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (frames < 3 * kPairs && !HasFailure() && std::chrono::steady_clock::now() < deadline) {
    receiver.receive(std::chrono::milliseconds(100));
  }
  stereod.send(SIGTERM);
  const ProgramRun run = stereod.wait();
  assembler.finish();
  EXPECT_EQ(run.status, 0) << run.err;
  const std::string method = std::string(GetParam().name) == "thesis" ? "block" : "semiglobal";
  EXPECT_NE(run.err.find("matcher " + method + " simd"), std::string::npos) << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_GE(frames, 3 * kPairs) << run.err;
  EXPECT_EQ(filled > 0, GetParam().name == std::string("dense"));
  EXPECT_EQ(assembler.counts().rows_lost, 0);
  EXPECT_EQ(assembler.counts().messages_ignored, 0);
}

INSTANTIATE_TEST_SUITE_P(
    E2e, StereodRows,
    testing::Values(
        Setting{"thesis", "{preset: thesis, disparities: 48}", {"--preset", "thesis", "--disparities", "48"}},
        Setting{"robust", "{preset: robust, disparities: 64}", {"--preset", "robust"}},
        Setting{"dense", "{preset: dense, disparities: 64}", {"--preset", "dense"}},
        Setting{"fine", "{preset: fine, disparities: 50}", {"--preset", "fine", "--disparities", "50"}}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST_F(StereodTest, RecordingOnce_Ends) {
  if (const auto why = why_no_multicast()) GTEST_SKIP() << *why;
  write_recorded_pairs(directory_.path(), kSize, kPairs);
  const std::filesystem::path file = directory_ / "once.yaml";
  std::ofstream(file)
      << "cameras: {source: replay, fps: 0, replay: {directory: ., loop: false}}\nlcm: {url: \"" << kUrl
      << "\", prefix: E2E}\n";
  int frames = 0;
  FrameAssembler assembler([&](StereoFrame&& frame) {
    EXPECT_EQ(frame.summary->left_sequence, frames);
    ++frames;
  });
  LcmReceiver receiver(kUrl);
  tools::TapOptions tap;
  tap.prefix = "E2E";
  tools::listen_for_frames(receiver, tap, assembler);
  ChildProgram stereod(kBin / "stereod", {"--config", file.string()}, directory_.path());
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (frames < kPairs && std::chrono::steady_clock::now() < deadline) {
    receiver.receive(std::chrono::milliseconds(100));
  }
  EXPECT_EQ(stereod.wait().status, 0);
  EXPECT_EQ(frames, kPairs);
}

TEST_F(StereodTest, Interrupt_CleanExit) {
  if (const auto why = why_no_multicast()) GTEST_SKIP() << *why;
  const std::filesystem::path file = directory_ / "demo.yaml";
  std::ofstream(file) << "cameras: {source: synthetic, synthetic: {width: 64, height: 48}}\nlcm: {url: \""
                      << kUrl << "\", prefix: E2E}\n";
  ChildProgram stereod(kBin / "stereod", {"--config", file.string()}, directory_.path());
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (stereod.err_so_far().find("streaming") == std::string::npos &&
         std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  stereod.send(SIGINT);
  const ProgramRun run = stereod.wait();
  EXPECT_EQ(run.status, 0);
  EXPECT_NE(run.err.find(" info: received SIGINT, shutting down"), std::string::npos) << run.err;
}

TEST_F(StereodTest, CheckAndList_Exclusive) {
  const ProgramRun run = run_stereod({"--check-config", "--list-cameras"});
  EXPECT_EQ(run.status, 78);
  EXPECT_NE(run.err.find("--check-config excludes --list-cameras"), std::string::npos) << run.err;
  EXPECT_EQ(run.out, "");
}

// Lines have a priority in the journal, a time elsewhere.
TEST_F(StereodTest, Log_PrioritiesOnlyInJournal) {
  const auto error_with_journal = [&](const std::string& journal) {
    return run_program("/bin/sh",
                       {"-c", "JOURNAL_STREAM=" + journal + " exec \"$0\" --config gone.yaml",
                        (kBin / "stereod").string()},
                       directory_.path())
        .err;
  };
  EXPECT_EQ(error_with_journal("$(stat -L -c %d:%i /proc/self/fd/2)").rfind("<3>gone.yaml: ", 0), 0u);
  const std::regex at_a_time("^[0-9:.]+ error: gone.yaml: ");
  EXPECT_TRUE(std::regex_search(error_with_journal("1:2"), at_a_time));
  EXPECT_TRUE(std::regex_search(error_with_journal(""), at_a_time));
}

TEST_F(StereodTest, MissingCameras_State) {
  if (const auto why = why_no_multicast()) GTEST_SKIP() << *why;
  const std::filesystem::path file = directory_ / "cameras.yaml";
  std::ofstream(file) << "cameras:\n  source: v4l2\n  v4l2: {left: 'serial:NOT-L', right: 'serial:NOT-R'}\n"
                      << "lcm: {url: \"" << kUrl << "\", prefix: E2E}\n";
  LcmReceiver receiver(kUrl);
  status_t status;
  receiver.subscribe("E2E_STATUS", [&](std::span<const std::byte> bytes) { decode_message(bytes, status); });
  ChildProgram stereod(kBin / "stereod", {"--config", file.string()}, directory_.path());
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (status.state != "waiting_for_cameras" && std::chrono::steady_clock::now() < deadline) {
    receiver.receive(std::chrono::milliseconds(100));
  }
  EXPECT_EQ(status.state, "waiting_for_cameras");
  EXPECT_EQ(
      status.reason,
      "no frames from either camera; no camera with the serial number NOT-L; plug it in; no camera with "
      "the serial number NOT-R; plug it in");
  EXPECT_EQ(status.left.state, "absent");
  EXPECT_EQ(status.right.state, "absent");
  stereod.send(SIGTERM);
  EXPECT_EQ(stereod.wait().status, 0);
}

// A recording in which the right camera moves: from one frame on, its image is four rows lower.
TEST_F(StereodTest, CameraMoved_CalibrationLost) {
  if (const auto why = why_no_multicast()) GTEST_SKIP() << *why;
  if (kSanitized) {
    GTEST_SKIP() << "a sanitizer slows the probe more than the matcher, whose time it may take a share of";
  }
  constexpr int kBefore = 200, kAfter = 300, kImages = 4;
  write_recorded_pairs(directory_.path(), kSize, kImages);
  std::filesystem::create_directory(directory_ / "play");
  for (int i = 0; i < kImages; ++i) {
    const GrayImage right = read_gray(recorded_right(directory_.path(), i));
    GrayImage lower(right.size());
    for (int y = 0; y < lower.height(); ++y) {
      std::copy_n(right.row(std::max(y - 4, 0)), lower.width(), lower.row(y));
    }
    write_png(directory_ / ("lower_" + std::to_string(i) + ".png"), lower.view());
  }
  for (int i = 0; i < kBefore + kAfter; ++i) {
    const auto name = [&](const char* side) {
      return directory_ / "play" / (side + std::to_string(i) + ".png");
    };
    std::filesystem::create_symlink(recorded_left(directory_.path(), i % kImages), name("left_"));
    std::filesystem::create_symlink(i < kBefore
                                        ? recorded_right(directory_.path(), i % kImages)
                                        : directory_ / ("lower_" + std::to_string(i % kImages) + ".png"),
                                    name("right_"));
  }
  const std::filesystem::path file = directory_ / "moved.yaml";
  std::ofstream(file) << "cameras: {source: replay, fps: 20, replay: {directory: play, loop: false}}\n"
                      << "calibration: calibration.yaml\nlcm: {url: \"" << kUrl << "\", prefix: E2E}\n";
  LcmReceiver receiver(kUrl);
  std::vector<status_t> before, after;
  receiver.subscribe("E2E_STATUS", [&](std::span<const std::byte> bytes) {
    status_t status;
    if (!decode_message(bytes, status) || status.state == "starting") return;
    (status.left.frames <= kBefore ? before : after).push_back(status);
  });
  ChildProgram stereod(kBin / "stereod", {"--config", file.string()}, directory_.path());
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while ((after.empty() || after.back().state != "degraded") && std::chrono::steady_clock::now() < deadline) {
    receiver.receive(std::chrono::milliseconds(100));
  }
  stereod.send(SIGTERM);
  const ProgramRun run = stereod.wait();
  ASSERT_FALSE(before.empty()) << run.err;
  for (const status_t& status : before) EXPECT_EQ(status.state, "streaming") << status.reason;
  EXPECT_GT(before.back().epipolar_points, 0);
  EXPECT_LT(before.back().epipolar_error_px, 0.5);
  ASSERT_FALSE(after.empty());
  const status_t& last = after.back();
  EXPECT_EQ(last.state, "degraded");
  EXPECT_EQ(last.reason.rfind("epipolar error ", 0), 0u) << last.reason;
  EXPECT_NE(last.reason.find(" px (limit 1 px): the cameras have moved"), std::string::npos) << last.reason;
  EXPECT_GT(last.epipolar_error_px, 1);
  // In recorded time, which does not depend on the load of the machine.
  EXPECT_LE(last.left.frames, kBefore + 20 * 6);
  EXPECT_NE(run.err.find("state: degraded: epipolar error "), std::string::npos) << run.err;
}

TEST_F(StereodTest, ListCameras_Prints) {
  const ProgramRun run = run_stereod({"--list-cameras"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out, "");
}

// stderr is a full pipe that is not read, then a pipe without a reader.
TEST_F(StereodTest, LogReaderStops_KeepsStreaming) {
  if (const auto why = why_no_multicast()) GTEST_SKIP() << *why;
  const std::filesystem::path config = directory_ / "demo.yaml";
  std::ofstream(config) << "cameras: {source: synthetic, synthetic: {width: 64, height: 48}}\nlcm: {url: \""
                        << kUrl << "\", prefix: E2E}\n";
  int ends[2];
  ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  ASSERT_EQ(::fcntl(ends[1], F_SETFL, O_NONBLOCK), 0);
  const std::string filling(4096, 'x');
  while (::write(ends[1], filling.data(), filling.size()) > 0) {
  }
  ASSERT_EQ(::fcntl(ends[1], F_SETFL, 0), 0);
  LcmReceiver receiver(kUrl);
  int frames = 0;
  receiver.subscribe("E2E_FRAME", [&](std::span<const std::byte>) { ++frames; });
  std::vector<std::string> words = starter_of(kBin / "stereod");
  words.insert(words.end(), {"--config", config.string()});
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  pid_t child = 0;
  ASSERT_EQ(::posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ), 0);
  posix_spawn_file_actions_destroy(&actions);
  const auto receive_frames = [&](int count) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    frames = 0;
    while (frames < count && std::chrono::steady_clock::now() < deadline) {
      receiver.receive(std::chrono::milliseconds(100));
    }
    return frames >= count;
  };
  EXPECT_TRUE(receive_frames(10)) << "with a full pipe";
  ::close(ends[0]);
  ::close(ends[1]);
  ::kill(child, SIGHUP);  // a line to log
  EXPECT_TRUE(receive_frames(10)) << "with a broken pipe";
  ::kill(child, SIGTERM);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST_F(StereodTest, Version_Printed) {
  const ProgramRun run = run_stereod({"--version"});
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.out.rfind("stereod ", 0), 0u) << run.out;
}

TEST_F(StereodTest, CheckConfig_Ok) {
  write_recorded_pairs(directory_.path(), kSize, 1);
  const std::string file = write_config("{preset: robust}").string();
  const ProgramRun run = run_stereod({"--check-config", "--config", file});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out, file + ": OK\n");
}

struct BadStart {
  const char* name;
  std::string config;
  std::string message;  // part of it
};

class StereodBadStart : public StereodTest, public testing::WithParamInterface<BadStart> {};

// With and without --check-config: the same line, and the status that keeps systemd from starting it again.
TEST_P(StereodBadStart, BadConfiguration_OneLineStatus78) {
  write_recorded_pairs(directory_.path(), kSize, 1);
  Calibration elsewhere = read_calibration(directory_ / "calibration.yaml");
  elsewhere.left.camera.cx = 999'999;
  write_calibration(directory_ / "elsewhere.yaml", elsewhere);
  const std::filesystem::path file = directory_ / "bad.yaml";
  std::ofstream(file) << GetParam().config;
  for (const bool check : {true, false}) {
    std::vector<std::string> arguments{"--config", file.string()};
    if (check) arguments.push_back("--check-config");
    const ProgramRun run = run_stereod(arguments);
    EXPECT_EQ(run.status, 78) << run.err;
    EXPECT_NE(run.err.find(GetParam().message), std::string::npos) << run.err;
    EXPECT_TRUE(std::regex_search(run.err, std::regex("^[0-9:.]+ error: "))) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  }
}

INSTANTIATE_TEST_SUITE_P(
    E2e, StereodBadStart,
    testing::Values(
        BadStart{"UnknownKey", "cameras: {source: synthetic}\nmatcher: {windw: 3}\n",
                 "bad.yaml:2: matcher.windw: is not a known key; the nearest known key is 'window'"},
        BadStart{"NotYaml", "cameras: [\n", "not valid YAML"},
        BadStart{"MissingImage", "cameras: {source: replay, replay: {left: gone.png, right: right_00.png}}\n",
                 "gone.png"},
        BadStart{"OtherCalibrationSize", "cameras: {source: synthetic}\ncalibration: calibration.yaml\n",
                 "calibration.yaml: the calibration is for images of 320×240, the cameras give 640×480"},
        BadStart{"CalibrationOfNoCamera",
                 "cameras: {source: synthetic, synthetic: {width: 320, height: 240}}\ncalibration: "
                 "elsewhere.yaml\n",
                 "only 0.0 % of the left rectified image"},
        BadStart{"MissingCalibration", "cameras: {source: synthetic}\ncalibration: gone.yaml\n", "gone.yaml"},
        BadStart{"ImpossibleIsa",
                 "cameras: {source: synthetic, synthetic: {width: 64, height: 48}}\nmatcher: {isa: " +
                     foreign_isa() + "}\n",
                 "bad.yaml:2: matcher.isa: isa " + foreign_isa() +
                     " is not available on this CPU or in this build"},
        BadStart{"TooManyRows", "cameras: {source: synthetic}\nlcm: {rows_per_message: 200}\n",
                 "bad.yaml:2: lcm.rows_per_message: found 200"},
        BadStart{"RegionOutside",
                 "cameras: {source: synthetic}\npublish: {region: {top: 400, height: 200}}\n",
                 "bad.yaml:2: publish.region: found 0×200 px at column 0, row 400 "},
        BadStart{"ScanWithoutCalibration",
                 "cameras: {source: replay, replay: {left: left_00.png, right: right_00.png}}\nscan: "
                 "{enabled: true}\n",
                 "bad.yaml:2: scan.enabled: found true, allowed without a calibration is false"},
        BadStart{
            "DepthWithoutCalibration",
            "cameras: {source: replay, replay: {left: left_00.png, right: right_00.png}}\npublish: {depth: "
            "true}\n",
            "bad.yaml:2: publish.depth: found true, allowed without a calibration is false"},
        BadStart{
            "CloudWithoutCalibration",
            "cameras: {source: replay, replay: {left: left_00.png, right: right_00.png}}\npublish: {cloud: "
            "true}\n",
            "bad.yaml:2: publish.cloud: found true, allowed without a calibration is false"},
        BadStart{"BadLcmUrl", "cameras: {source: synthetic}\nlcm: {url: \"carrier-pigeon://\"}\n",
                 "bad.yaml:2: lcm.url: LCM URL 'carrier-pigeon://'"}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace stereod
