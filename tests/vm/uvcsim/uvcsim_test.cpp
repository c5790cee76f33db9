// SPDX-License-Identifier: BSD-3-Clause
// The simulated webcam's parts, without a kernel.
#include <gmock/gmock.h>
#include <turbojpeg.h>

#include <memory>

#include "tests/vm/uvcsim/command.h"
#include "tests/vm/uvcsim/controls.h"
#include "tests/vm/uvcsim/descriptors.h"
#include "tests/vm/uvcsim/scene.h"
#include "tests/vm/uvcsim/scene_images.h"
#include "tests/vm/uvcsim/shutter.h"
#include "tests/vm/uvcsim/stream_format.h"
#include "tests/vm/uvcsim/usbip.h"

namespace stereod::uvcsim {
namespace {

using testing::HasSubstr;

// The control selectors of the specification.
constexpr std::uint8_t kExposureMode = 2, kExposureTime = 4, kGain = 4;

bool set(Controls& controls, std::uint8_t unit, std::uint8_t selector, std::uint32_t value, int length) {
  Bytes data;
  put_little(data, value, length);
  return controls.answer(ControlRequest::kSetCurrent, unit, selector, data).has_value();
}

TEST(UvcsimDescriptors, Lengths_AddUp) {
  const Bytes bytes = configuration_descriptor();
  EXPECT_EQ(get_little(bytes, 2, 2), bytes.size());
  std::size_t at = 0, endpoints = 0, frames = 0;
  while (at < bytes.size()) {
    ASSERT_GE(bytes[at], 2);
    endpoints += bytes[at + 1] == 5 ? 1 : 0;
    frames += bytes[at + 1] == 0x24 && (bytes[at + 2] == 5 || bytes[at + 2] == 7) && bytes[at] == 42 ? 1 : 0;
    at += bytes[at];
  }
  EXPECT_EQ(at, bytes.size());
  EXPECT_EQ(endpoints, 1U);
  EXPECT_EQ(frames, 2 * kSizes.size());
}

TEST(UvcsimDescriptors, DeviceAndStrings_Correct) {
  EXPECT_EQ(device_descriptor().size(), 18U);
  EXPECT_EQ(string_descriptor(3, "A1"), (Bytes{6, 3, 'A', 0, '1', 0}));
  EXPECT_EQ(string_descriptor(0, "A1"), (Bytes{4, 3, 9, 4}));
}

TEST(UvcsimUsbip, Submit_ReadAndAnswered) {
  Bytes header;
  for (const std::uint32_t word : {1U, 7U, 65537U, 1U, 0U, 0U, 18U, 0U, 0U, 0U}) put_big(header, word);
  header.insert(header.end(), {0x80, 6, 0, 1, 2, 3, 18, 0});
  const auto message = parse_usbip(header);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->sequence, 7U);
  EXPECT_TRUE(message->to_host);
  EXPECT_EQ(message->length, 18U);
  EXPECT_EQ(message->payload(), 0U);
  EXPECT_EQ(message->setup.value, 0x0100);
  EXPECT_EQ(message->setup.index, 0x0302);

  const Bytes reply = submit_reply(7, -32, 2, Bytes{1, 2});
  ASSERT_EQ(reply.size(), kUsbipHeader + 2);
  EXPECT_EQ(get_big(reply, 0), 3U);
  EXPECT_EQ(get_big(reply, 4), 7U);
  EXPECT_EQ(static_cast<std::int32_t>(get_big(reply, 20)), -32);
  EXPECT_EQ(get_big(reply, 24), 2U);
}

TEST(UvcsimUsbip, Unlink_ReadAndRubbishRefused) {
  Bytes header;
  for (const std::uint32_t word : {2U, 9U, 0U, 0U, 0U, 7U}) put_big(header, word);
  header.resize(kUsbipHeader);
  const auto message = parse_usbip(header);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->kind, UsbipMessage::Kind::kUnlink);
  EXPECT_EQ(message->unlinked, 7U);
  EXPECT_EQ(static_cast<std::int32_t>(get_big(unlink_reply(9, true), 20)), -104);
  EXPECT_EQ(get_big(unlink_reply(9, false), 20), 0U);
  EXPECT_FALSE(parse_usbip(Bytes(kUsbipHeader, 0xff)));
  EXPECT_FALSE(parse_usbip(Bytes(3)));
}

TEST(UvcsimFormat, Request_NearestNegotiated) {
  const StreamFormat wish{Encoding::kYuyv, {320, 240}, 600'000};
  const StreamFormat agreed = negotiated(negotiation_bytes(wish));
  EXPECT_EQ(agreed.encoding, Encoding::kYuyv);
  EXPECT_EQ(agreed.size, (Size{320, 240}));
  EXPECT_EQ(agreed.frame_time, 666'666U);
  EXPECT_EQ(negotiation_bytes(agreed).size(), kNegotiationBytes);
  EXPECT_EQ(negotiated(Bytes(kNegotiationBytes, 0xff)).size, kSizes[0]);
}

TEST(UvcsimControls, AutoExposure_ExposureTimeRefused) {
  Controls controls;
  EXPECT_FALSE(set(controls, kCameraUnit, kExposureTime, 40, 4));
  EXPECT_EQ(controls.error_code(), 4);
  EXPECT_TRUE(set(controls, kCameraUnit, kExposureMode, 1, 1));
  EXPECT_TRUE(set(controls, kCameraUnit, kExposureTime, 78, 4));
  EXPECT_EQ(controls.error_code(), 0);
  EXPECT_EQ(controls.gain_64(), 32);
  EXPECT_TRUE(set(controls, kProcessingUnit, kGain, 64, 2));
  EXPECT_EQ(controls.gain_64(), 64);
  EXPECT_FALSE(set(controls, kProcessingUnit, 99, 0, 2));
  EXPECT_EQ(controls.error_code(), 6);
}

TEST(UvcsimControls, AutoExposure_CompensatesLight) {
  Controls controls;
  controls.set_light(50);
  EXPECT_EQ(controls.gain_64(), 64);
  const auto time = controls.answer(ControlRequest::kGetCurrent, kCameraUnit, kExposureTime, {});
  ASSERT_TRUE(time);
  EXPECT_EQ(get_little(*time, 0, 4), 312U);
  EXPECT_TRUE(set(controls, kCameraUnit, kExposureMode, 1, 1));
  controls.set_light(100);
  EXPECT_EQ(controls.gain_64(), 128);
}

TEST(UvcsimScene, RightEye_ShiftedByDisparity) {
  for (const int y : {0, 59, 60, 200, 479}) {
    const int d = scene_disparity(y);
    EXPECT_GE(d, 8);
    EXPECT_LE(d, 32);
    for (int x = d; x < 640; ++x) {
      ASSERT_EQ(scene_brightness(Eye::kLeft, x, y, 3), scene_brightness(Eye::kRight, x - d, y, 3));
    }
  }
}

TEST(UvcsimScene, Frames_DifferAndRepeat) {
  EXPECT_EQ(scene_brightness(Eye::kLeft, 5, 5, 1), scene_brightness(Eye::kLeft, 5, 5, 1 + kSceneFrames));
  EXPECT_NE(scene_brightness(Eye::kLeft, 5, 5, 1), scene_brightness(Eye::kLeft, 5, 5, 2));
  EXPECT_EQ(render_scene(Eye::kLeft, {64, 48}, 0, 0, 7).row(3)[3], 7);
}

TEST(UvcsimImages, JpegWithoutTables_Decodable) {
  const GrayImage image = render_scene(Eye::kLeft, {320, 240}, 1);
  const Bytes jpeg = webcam_jpeg(image);
  for (std::size_t i = 0; i + 1 < jpeg.size() && jpeg[i + 1] != 0xda; ++i) {
    ASSERT_FALSE(jpeg[i] == 0xff && jpeg[i + 1] == 0xc4);
  }
  const std::unique_ptr<void, int (*)(void*)> decoder(tjInitDecompress(), tjDestroy);
  Bytes gray(320 * 240);
  const auto decode = [&](const Bytes& bytes) {
    return tjDecompress2(decoder.get(), bytes.data(), bytes.size(), gray.data(), 320, 320, 240, TJPF_GRAY, 0);
  };
  ASSERT_EQ(decode(jpeg), 0) << tjGetErrorStr2(decoder.get());
  EXPECT_NEAR(gray[100 * 320 + 100], image.row(100)[100], 12);

  Bytes damaged = jpeg;
  corrupt_jpeg(damaged);
  EXPECT_NE(decode(damaged), 0);
  damaged = jpeg;
  change_jpeg_height(damaged, 16);
  int width = 0, height = 0, subsampling = 0, colors = 0;
  ASSERT_EQ(tjDecompressHeader3(decoder.get(), damaged.data(), damaged.size(), &width, &height, &subsampling,
                                &colors),
            0);
  EXPECT_EQ(height, 256);
}

TEST(UvcsimShutter, Phase_FirstStreamOnly) {
  constexpr std::int64_t kFrame = 33'333'300;
  Shutter shutter;
  shutter.set_phase(16'000'000);
  shutter.start(1'000'000'007, kFrame);
  EXPECT_EQ(shutter.due_ns() % kFrame, 16'000'000);
  EXPECT_GT(shutter.due_ns(), 1'000'000'007);
  shutter.start(2'000'000'000, kFrame);
  EXPECT_EQ(shutter.due_ns(), 2'000'000'000 + Shutter::kStartTime);
}

TEST(UvcsimShutter, Drift_AddsUpMissedFramesSkipped) {
  constexpr std::int64_t kFrame = 10'000'000;
  Shutter shutter;
  shutter.set_drift(100);
  shutter.start(0, kFrame);
  const std::int64_t first = shutter.due_ns();
  for (int i = 0; i < 1000; ++i) shutter.advance(shutter.due_ns());
  EXPECT_EQ(shutter.due_ns() - first, 1000 * (kFrame + 1000));
  EXPECT_EQ(shutter.frame(), 1000);
  shutter.advance(shutter.due_ns() + 5 * kFrame);
  EXPECT_EQ(shutter.frame(), 1005);
}

TEST(UvcsimCommand, Line_ParsedOrRefused) {
  std::string complaint;
  ASSERT_TRUE(parse_command("unplug", complaint));
  const auto plug = parse_command("plug 3", complaint);
  ASSERT_TRUE(plug);
  EXPECT_EQ(plug->verb, Verb::kPlug);
  EXPECT_EQ(plug->number, 3);
  EXPECT_EQ(parse_command("drift -50", complaint)->number, -50);
  EXPECT_FALSE(parse_command("plug three", complaint));
  EXPECT_THAT(complaint, HasSubstr("whole number"));
  EXPECT_FALSE(parse_command("error", complaint));
  EXPECT_THAT(complaint, HasSubstr("needs a whole number"));
  EXPECT_FALSE(parse_command("freeze 3", complaint));
  EXPECT_FALSE(parse_command("explode", complaint));
  EXPECT_THAT(complaint, HasSubstr("unplug, plug, freeze"));
}

}  // namespace
}  // namespace stereod::uvcsim
