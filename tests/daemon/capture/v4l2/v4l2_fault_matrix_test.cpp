// SPDX-License-Identifier: BSD-3-Clause
// Every error at every stage: the state and reason of the camera, and its recovery.
#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <cerrno>
#include <cstdio>
#include <map>

#include "tests/support/camera_bench.h"

namespace stereod::v4l2 {
namespace {

struct Step {
  const char* name;
  unsigned long request;
  bool streaming;  // the error comes while the camera streams
};

constexpr Step kSteps[] = {
    {"open", kFakeOpen, false},
    {"QUERYCAP", VIDIOC_QUERYCAP, false},
    {"ENUM_FMT", VIDIOC_ENUM_FMT, false},
    {"ENUM_FRAMESIZES", VIDIOC_ENUM_FRAMESIZES, false},
    {"ENUM_FRAMEINTERVALS", VIDIOC_ENUM_FRAMEINTERVALS, false},
    {"S_FMT", VIDIOC_S_FMT, false},
    {"S_PARM", VIDIOC_S_PARM, false},
    {"REQBUFS", VIDIOC_REQBUFS, false},
    {"QUERYBUF", VIDIOC_QUERYBUF, false},
    {"mmap", kFakeMap, false},
    {"QBUF", VIDIOC_QBUF, false},
    {"STREAMON", VIDIOC_STREAMON, false},
    {"poll", kFakePoll, true},
    {"DQBUF", VIDIOC_DQBUF, true},
    {"QBUF, streaming", VIDIOC_QBUF, true},
    {"STREAMOFF", VIDIOC_STREAMOFF, true},
};

struct Error {
  const char* name;
  int number;
};
constexpr Error kErrors[] = {{"EAGAIN", EAGAIN}, {"EIO", EIO},     {"ENODEV", ENODEV},
                             {"ENOSPC", ENOSPC}, {"EBUSY", EBUSY}, {"EINVAL", EINVAL}};

// Returns what the camera reports after the error: "state: reason", or "streaming" if the error has no
// effect.
std::string outcome(const Step& step, const Error& error, bool& recovered) {
  CameraBench bench;
  bench.config.v4l2.format = "yuyv";
  FakeCamera& camera = *bench.left_camera;
  constexpr int kForAWhile = 1'000'000;
  if (!step.streaming) camera.faults[step.request] = {error.number, kForAWhile, 0};
  bench.make();
  if (step.streaming) {
    EXPECT_TRUE(bench.frame(*bench.left));
    camera.faults[step.request] = {error.number, kForAWhile, 0};
  }
  for (int i = 0; i < 15; ++i) bench.frame(*bench.left, 100);
  const SourceReport report = bench.left->report();
  std::string said(name_of(report.state));
  if (report.state != SourceState::kStreaming)
    said += ": " + std::string(name_of(bench.left->fault().reason));

  camera.faults.clear();
  const std::int64_t possible_ns = bench.video.now_ns();
  recovered = static_cast<bool>(bench.frame(*bench.left, 5000)) &&
              bench.video.now_ns() - possible_ns < 2'000'000'000 &&
              bench.left->report().state == SourceState::kStreaming;
  bench.left.reset();
  EXPECT_EQ(bench.video.open_descriptors(), 0) << step.name << ", " << error.name;
  EXPECT_EQ(bench.video.mappings(), 0) << step.name << ", " << error.name;
  return said;
}

// The table in docs/cameras.md: one line for each stage, in the order of kErrors.
const std::map<std::string, std::vector<std::string>> kExpected = {
    {"open",
     {"opening: driver error", "opening: driver error", "absent: unplugged", "opening: driver error",
      "opening: busy", "opening: driver error"}},
    {"QUERYCAP",
     {"opening: driver error", "opening: driver error", "absent: unplugged", "opening: driver error",
      "opening: busy", "opening: no camera"}},
    {"ENUM_FMT",
     {"opening: driver error", "opening: driver error", "absent: unplugged", "opening: driver error",
      "opening: busy", "opening: no format"}},
    {"ENUM_FRAMESIZES",
     {"opening: driver error", "opening: driver error", "absent: unplugged", "opening: driver error",
      "opening: busy", "streaming"}},
    {"ENUM_FRAMEINTERVALS", {"streaming", "streaming", "streaming", "streaming", "streaming", "streaming"}},
    {"S_FMT",
     {"opening: driver error", "opening: driver error", "absent: unplugged", "opening: no bandwidth",
      "opening: busy", "opening: no format"}},
    {"S_PARM",
     {"opening: driver error", "opening: driver error", "absent: unplugged", "opening: no bandwidth",
      "opening: busy", "streaming"}},
    {"REQBUFS",
     {"opening: driver error", "opening: driver error", "absent: unplugged", "opening: no bandwidth",
      "opening: busy", "opening: driver error"}},
    {"QUERYBUF",
     {"opening: driver error", "opening: driver error", "absent: unplugged", "opening: no bandwidth",
      "opening: busy", "opening: driver error"}},
    {"mmap",
     {"opening: driver error", "opening: driver error", "absent: unplugged", "opening: no bandwidth",
      "opening: busy", "opening: driver error"}},
    {"QBUF",
     {"opening: driver error", "opening: driver error", "absent: unplugged", "opening: no bandwidth",
      "opening: busy", "opening: driver error"}},
    {"STREAMON",
     {"opening: driver error", "opening: driver error", "absent: unplugged", "opening: no bandwidth",
      "opening: busy", "opening: driver error"}},
    {"poll",
     {"lost: driver error", "lost: driver error", "lost: driver error", "lost: driver error",
      "lost: driver error", "lost: driver error"}},
    {"DQBUF",
     {"stalled: silent", "lost: driver error", "lost: unplugged", "lost: no bandwidth", "lost: busy",
      "lost: driver error"}},
    {"QBUF, streaming",
     {"lost: driver error", "lost: driver error", "absent: unplugged", "lost: no bandwidth", "lost: busy",
      "lost: driver error"}},
    {"STREAMOFF", {"streaming", "streaming", "streaming", "streaming", "streaming", "streaming"}},
};

TEST(V4l2FaultMatrix, EveryErrorAtEveryStage_Recovered) {
  std::printf("%-20s", "step");
  for (const Error& error : kErrors) std::printf(" | %-22s", error.name);
  std::printf("\n");
  for (const Step& step : kSteps) {
    std::printf("%-20s", step.name);
    for (std::size_t i = 0; i < std::size(kErrors); ++i) {
      bool recovered = false;
      const std::string said = outcome(step, kErrors[i], recovered);
      std::printf(" | %-22s", said.c_str());
      EXPECT_EQ(said, kExpected.at(step.name).at(i)) << step.name << ", " << kErrors[i].name;
      EXPECT_TRUE(recovered) << step.name << ", " << kErrors[i].name;
    }
    std::printf("\n");
  }
}

// The driver fails at random calls.
TEST(V4l2FaultMatrix, RandomFaults_NoLeaks) {
  CameraBench bench;
  bench.make();
  std::uint32_t state = 1;
  const auto random = [&](std::uint32_t below) {
    state = state * 1664525u + 1013904223u;
    return (state >> 8) % below;
  };
  for (int round = 0; round < 300; ++round) {
    const Step& step = kSteps[random(std::size(kSteps))];
    FakeCamera& camera = random(2) == 0 ? *bench.left_camera : *bench.right_camera;
    camera.faults[step.request] = {kErrors[random(std::size(kErrors))].number,
                                   static_cast<int>(random(3)) + 1, static_cast<int>(random(4))};
    if (random(8) == 0) bench.video.plug(camera, !camera.plugged);
    if (random(8) == 0) camera.frozen = !camera.frozen;
    bench.run(random(3000));
  }
  for (FakeCamera* camera : {bench.left_camera, bench.right_camera}) {
    camera->faults.clear();
    camera->frozen = false;
    bench.video.plug(*camera, true);
  }
  bench.run(2000);
  const CameraBench::Frames frames = bench.run(2000);
  EXPECT_GT(frames.left, 50);
  EXPECT_GT(frames.right, 50);
  EXPECT_EQ(bench.video.open_descriptors(), 2);
  EXPECT_EQ(bench.video.mappings(), 12);
}

}  // namespace
}  // namespace stereod::v4l2
