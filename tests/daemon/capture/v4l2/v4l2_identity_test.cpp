// SPDX-License-Identifier: BSD-3-Clause
// Which camera is which: names, ports, functions of one device.
#include <gmock/gmock.h>
#include <linux/videodev2.h>

#include <cerrno>
#include <utility>

#include "daemon/capture/v4l2/camera_list.h"
#include "tests/support/camera_bench.h"

namespace stereod::v4l2 {
namespace {

using testing::HasSubstr;

class V4l2Identity : public testing::Test {
 protected:
  CameraBench bench_;
};

TEST_F(V4l2Identity, SwappedPorts_FollowPort) {
  bench_.make();
  bench_.run(300);
  bench_.video.plug(*bench_.left_camera, false);
  bench_.video.plug(*bench_.right_camera, false);
  bench_.run(300);
  std::swap(bench_.left_camera->node, bench_.right_camera->node);
  bench_.video.plug(*bench_.right_camera, true);
  bench_.video.plug(*bench_.left_camera, true);
  EXPECT_GE(bench_.run(1000).left, 20);
  EXPECT_THAT(bench_.left->report().device, HasSubstr("/dev/video2"));
  EXPECT_THAT(bench_.right->report().device, HasSubstr("/dev/video0"));
}

TEST_F(V4l2Identity, SameNodeTwice_Refused) {
  bench_.config.v4l2.right = "/dev/video0";
  bench_.make();
  const CameraBench::Frames frames = bench_.run(2000);
  EXPECT_GT(frames.left, 40);
  EXPECT_EQ(frames.right, 0);
  EXPECT_EQ(bench_.right->report().reason,
            "/dev/video0 belongs to the camera that is the left one; name two cameras in cameras.v4l2");
}

TEST_F(V4l2Identity, TwoNodesOfOneSensor_Refused) {
  bench_.right_camera->bus = bench_.left_camera->bus;  // as a device with two cameras has
  bench_.make();
  EXPECT_GT(bench_.run(2000).right, 40);
  bench_.left_camera->function = bench_.right_camera->function = "1-2:1.0";
  bench_.make();
  EXPECT_EQ(bench_.run(2000).right, 0);
  EXPECT_EQ(bench_.right->fault().reason, CameraReason::kSameCamera);
  EXPECT_THAT(bench_.right->report().reason,
              HasSubstr("/dev/video2 belongs to the camera that is the left one"));
  bench_.config.v4l2.left = bench_.config.v4l2.right = "auto";
  bench_.make();
  EXPECT_EQ(bench_.run(1000).left, 0);
  EXPECT_THAT(bench_.left->report().reason, HasSubstr("only /dev/video0 is plugged in"));
}

TEST_F(V4l2Identity, SwappedAtOnce_NoConflict) {
  bench_.make();
  bench_.run(300);
  bench_.video.plug(*bench_.left_camera, false);
  bench_.video.plug(*bench_.right_camera, false);
  std::swap(bench_.left_camera->node, bench_.right_camera->node);
  bench_.video.plug(*bench_.left_camera, true);
  bench_.video.plug(*bench_.right_camera, true);
  EXPECT_GE(bench_.run(500).left, 5);
  EXPECT_THAT(bench_.left->report().device, HasSubstr("/dev/video2"));
  EXPECT_THAT(bench_.right->report().device, HasSubstr("/dev/video0"));
  EXPECT_THAT(bench_.log, testing::Not(testing::Contains(HasSubstr("belongs to"))));
}

TEST_F(V4l2Identity, MetadataNode_NoCamera) {
  bench_.left_camera->capture = false;
  bench_.make();
  EXPECT_FALSE(bench_.frame(*bench_.left, 1000));
  EXPECT_THAT(bench_.left->report().reason, HasSubstr("gives no images"));
}

TEST_F(V4l2Identity, EveryKindOfName_Found) {
  FakeCamera metadata;
  metadata.node = "/dev/video1";
  metadata.serial = "LEFT";
  metadata.capture = false;
  metadata.links = {"/dev/v4l/by-path/port-0"};  // before the cameras
  bench_.video.add(metadata);
  for (const char* name : {"/dev/video0", "/dev/v4l/by-path/port-1", "/dev/v4l/by-id/usb-LEFT-video-index0",
                           "port-1", "usb-LEFT-video-index0", "serial:LEFT", "auto"}) {
    bench_.config.v4l2.left = name;
    bench_.make();
    ASSERT_TRUE(bench_.frame(*bench_.left)) << name;
    EXPECT_THAT(bench_.left->report().device, HasSubstr("/dev/video0")) << name;
  }
  bench_.config.v4l2.left = "serial:OTHER";
  bench_.make();
  EXPECT_FALSE(bench_.frame(*bench_.left, 500));
  EXPECT_EQ(bench_.left->report().reason, "no camera with the serial number OTHER; plug it in");
}

TEST_F(V4l2Identity, Auto_StaysWithPort) {
  bench_.config.v4l2.left = bench_.config.v4l2.right = "auto";
  bench_.make();
  bench_.run(500);
  EXPECT_THAT(bench_.left->report().device, HasSubstr("/dev/video0"));
  EXPECT_THAT(bench_.right->report().device, HasSubstr("/dev/video2"));
  bench_.video.plug(*bench_.left_camera, false);
  bench_.run(500);
  EXPECT_THAT(bench_.left->report().reason, HasSubstr("port-1"));
  EXPECT_EQ(bench_.right->report().state, SourceState::kStreaming);
}

TEST_F(V4l2Identity, AutoWithOneCamera_Waits) {
  bench_.config.v4l2.left = bench_.config.v4l2.right = "auto";
  bench_.right_camera->plugged = false;
  bench_.make();
  EXPECT_EQ(bench_.run(1000).left, 0);
  EXPECT_THAT(bench_.left->report().reason, HasSubstr("only /dev/video0 is plugged in"));
  bench_.video.plug(*bench_.right_camera, true);
  EXPECT_GT(bench_.run(1000).left, 10);
}

TEST_F(V4l2Identity, NotPermitted_ReasonNamed) {
  for (FakeCamera* camera : {bench_.left_camera, bench_.right_camera}) {
    camera->faults[kFakeOpen] = {EACCES, 1'000'000};
  }
  for (const char* name : {"auto", "serial:LEFT"}) {
    bench_.config.v4l2.left = bench_.config.v4l2.right = name;
    bench_.make();
    EXPECT_FALSE(bench_.frame(*bench_.left, 1000));
    EXPECT_EQ(bench_.left->fault().reason, CameraReason::kNotPermitted) << name;
    EXPECT_THAT(bench_.left->report().reason, HasSubstr("add this user to the group")) << name;
  }
}

TEST_F(V4l2Identity, List_NamesEverything) {
  bench_.left_camera->controls = {{V4L2_CID_GAIN, "Gain", 0, 100, 10, 20}};
  bench_.left_camera->card = "Fake Camera\x1b[2J";
  bench_.right_camera->capture = false;
  const std::string list = list_cameras(bench_.video);
  for (const char* part :
       {"Fake Camera", "/dev/v4l/by-path/port-1", "/dev/v4l/by-id/usb-LEFT-video-index0", "serial:LEFT",
        "/dev/video0 (may change)", "usb-0000:00:14.0-1", "64×48 at 30", "20  (range 0…100, default 10)"}) {
    EXPECT_THAT(list, HasSubstr(part));
  }
  EXPECT_THAT(list, testing::Not(HasSubstr("\x1b")))
      << "what a device calls itself does not reach the terminal";
  EXPECT_THAT(list, testing::Not(HasSubstr("RIGHT"))) << "a metadata node is no camera";
  bench_.left_camera->faults[kFakeOpen] = {EACCES, 1};
  EXPECT_THAT(list_cameras(bench_.video), HasSubstr("/dev/video0 cannot be opened: Permission denied"));
}

}  // namespace
}  // namespace stereod::v4l2
