// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary bytes as a camera's buffer: checks, timestamps, JPEG decoder, luma. An accepted frame must be
// readable to its last pixel. Built with clang and -fsanitize=fuzzer this is a fuzzer; otherwise
// fuzz_by_mutation.cpp runs it as a test.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "daemon/capture/v4l2/frame_check.h"
#include "daemon/capture/v4l2/luma_decoder.h"
#include "tests/fuzz/camera_frame_fuzz.h"

namespace stereod {

bool last_input_was_a_frame = false;

namespace {

using namespace v4l2;

constexpr std::int64_t kNow = 5'000'000'000;

/// The head of the input is the driver's answer, the rest is the buffer.
struct Input {
  Input(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t kHead = 16;
    std::uint8_t head[kHead] = {};
    std::memcpy(head, data, size < kHead ? size : kHead);
    const std::span<const PixelFormat> formats = pixel_formats();
    format = formats[head[0] % formats.size()];
    device.fourcc = format.fourcc;
    device.size = {16 + head[1] % 4 * 16, 8 + head[2] % 4 * 8};
    device.bytes_per_line = head[3];
    filled.error = (head[4] & 1) != 0;
    filled.timestamp_monotonic = (head[4] & 2) != 0;
    filled.timestamp_start = (head[4] & 4) != 0;
    std::memcpy(&filled.timestamp_ns, head + 5, 8);
    if ((head[4] & 8) != 0) filled.timestamp_ns = kNow - head[5] * 1'000'000;
    if (size > kHead) buffer.assign(data + kHead, data + size);
    filled.bytes = static_cast<std::uint32_t>(buffer.size());
    if ((head[4] & 16) != 0) std::memcpy(&filled.bytes, head + 12, 4);
  }
  PixelFormat format;
  DeviceFormat device;
  FilledBuffer filled;
  std::vector<std::uint8_t>
      buffer;  // of the exact length, so that the address sanitizer sees a read past its end
};

volatile unsigned read_all;  // keeps the compiler from omitting the reads

unsigned sum_of(const LumaView& luma) {
  unsigned sum = 0;
  for (int y = 0; y < luma.size.height; ++y) {
    for (int x = 0; x < luma.size.width; ++x) sum += luma.data[y * luma.row_stride + x * luma.pixel_stride];
  }
  return sum;
}

void must(bool condition) {
  if (!condition) std::abort();
}

void check(const Input& input) {
  static JpegLumaDecoder decoder;
  last_input_was_a_frame = false;
  FrameDrop drop = FrameDrop::kNoRoom;
  const std::size_t min_bytes = min_buffer_bytes(input.format, input.device);
  if (!is_complete(input.filled, input.buffer.size(), min_bytes, drop)) {
    must(drop == FrameDrop::kDriverError || drop == FrameDrop::kEmpty || drop == FrameDrop::kShort);
    return;
  }
  TimestampFilter timestamps;
  timestamps.reset(33'333'333, 0);
  std::int64_t start_ns = 0;
  if (!timestamps.start_of_exposure(input.filled, kNow, start_ns, drop)) {
    must(drop == FrameDrop::kStale);
  } else {
    must(start_ns <= kNow + 20'000'000 && start_ns >= kNow - 1'100'000'000);
  }
  GrayImage image(input.device.size);
  const std::span<const std::uint8_t> bytes(input.buffer.data(), input.filled.bytes);
  switch (input.format.work) {
    case LumaWork::kNone:
      read_all = sum_of(luma_in_place(input.format, input.device, input.buffer.data()));
      break;
    case LumaWork::kScale:
      scale_y10(bytes.data(), row_stride(input.format, input.device), image.view());
      break;
    case LumaWork::kJpeg:
      if (!decoder.decode(bytes, image.view(), drop)) {
        must(drop == FrameDrop::kNoJpeg || drop == FrameDrop::kJpegSize || drop == FrameDrop::kJpegDamaged);
        return;
      }
  }
  last_input_was_a_frame = true;
}

}  // namespace
}  // namespace stereod

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  stereod::check({data, size});
  return 0;
}
