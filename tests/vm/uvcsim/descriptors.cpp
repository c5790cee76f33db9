// SPDX-License-Identifier: BSD-3-Clause
// Assembling descriptors.
#include "tests/vm/uvcsim/descriptors.h"

#include <array>
#include <initializer_list>

#include "tests/vm/uvcsim/stream_format.h"

namespace stereod::uvcsim {
namespace {

constexpr std::uint8_t kConfiguration = 2, kInterface = 4, kEndpoint = 5, kAssociation = 11,
                       kClassSpecific = 0x24;
constexpr std::uint8_t kVideo = 14, kVideoControl = 1, kVideoStreaming = 2, kVideoCollection = 3;

// A descriptor: its length, then its bytes.
class Descriptor {
 public:
  explicit Descriptor(std::initializer_list<std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) bytes_.push_back(byte);
  }
  Descriptor& u8(std::uint32_t value) { return number(value, 1); }
  Descriptor& u16(std::uint32_t value) { return number(value, 2); }
  Descriptor& u32(std::uint32_t value) { return number(value, 4); }
  void end(Bytes& to) const {
    put_little(to, static_cast<std::uint32_t>(bytes_.size() + 1), 1);
    for (const std::uint8_t byte : bytes_) to.push_back(byte);
  }

 private:
  Descriptor& number(std::uint32_t value, int count) {
    put_little(bytes_, value, count);
    return *this;
  }
  Bytes bytes_;
};

void patch16(Bytes& bytes, std::size_t at, std::size_t value) {
  bytes[at] = static_cast<std::uint8_t>(value);
  bytes[at + 1] = static_cast<std::uint8_t>(value >> 8);
}

void interface(Bytes& to, std::uint8_t number, std::uint8_t endpoints, std::uint8_t subclass) {
  Descriptor{kInterface, number, 0, endpoints, kVideo, subclass, 0, 0}.end(to);
}

// Lens → processing unit → USB.
void control_interface(Bytes& to) {
  constexpr std::uint32_t kClock = 48'000'000;
  constexpr std::uint32_t kLensControls = 0x00e;  // automatic exposure: mode and priority; exposure time
  constexpr std::uint32_t kProcessingControls =
      0x1641;  // brightness, white balance and its automation, gain, power line
  interface(to, kControlInterface, 0, kVideoControl);
  const std::size_t header = to.size();
  Descriptor{kClassSpecific, 1}.u16(0x0100).u16(0).u32(kClock).u8(1).u8(kStreamInterface).end(to);
  Descriptor{kClassSpecific, 2, kCameraUnit}
      .u16(0x0201)
      .u16(0)
      .u16(0)
      .u16(0)
      .u16(0)
      .u8(3)
      .u16(kLensControls)
      .u8(0)
      .end(to);
  Descriptor{kClassSpecific, 5, kProcessingUnit, kCameraUnit}
      .u16(0)
      .u8(2)
      .u16(kProcessingControls)
      .u8(0)
      .end(to);
  Descriptor{kClassSpecific, 3, 3}.u16(0x0101).u8(0).u8(kProcessingUnit).u8(0).end(to);
  patch16(to, header + 5, to.size() - header);
}

void sizes(Bytes& to, std::uint8_t subtype) {
  std::uint8_t number = 0;
  for (const Size size : kSizes) {
    const std::uint32_t bytes = max_image_bytes(size);
    Descriptor d{kClassSpecific, subtype, ++number, 0};
    d.u16(static_cast<std::uint32_t>(size.width)).u16(static_cast<std::uint32_t>(size.height));
    d.u32(bytes * 8 * 10).u32(bytes * 8 * 30).u32(bytes);
    d.u32(kFrameTimes[0]).u8(kFrameTimes.size());
    for (const std::uint32_t time : kFrameTimes) d.u32(time);
    d.end(to);
  }
  Descriptor{kClassSpecific, 13, 1, 1, 4}.end(to);  // colors as in BT.601
}

void stream_interface(Bytes& to) {
  constexpr std::array<std::uint8_t, 16> kYuy2{'Y',  'U', 'Y', '2',  0, 0,    0x10, 0,
                                               0x80, 0,   0,   0xaa, 0, 0x38, 0x9b, 0x71};
  constexpr auto kSizeCount = static_cast<std::uint8_t>(kSizes.size());
  interface(to, kStreamInterface, 1, kVideoStreaming);
  const std::size_t header = to.size();
  Descriptor{kClassSpecific, 1, 2}
      .u16(0)
      .u8(0x80 | kStreamEndpoint)
      .u8(0)
      .u8(3)
      .u8(0)
      .u8(0)
      .u8(0)
      .u8(1)
      .u8(0)
      .u8(0)
      .end(to);
  Descriptor yuyv{kClassSpecific, 4, static_cast<std::uint8_t>(Encoding::kYuyv), kSizeCount};
  for (const std::uint8_t byte : kYuy2) yuyv.u8(byte);
  yuyv.u8(16).u8(1).u8(0).u8(0).u8(0).u8(0).end(to);
  sizes(to, 5);
  Descriptor{kClassSpecific, 6, static_cast<std::uint8_t>(Encoding::kMjpeg), kSizeCount, 0, 1, 0, 0, 0, 0}
      .end(to);
  sizes(to, 7);
  patch16(to, header + 4, to.size() - header);
  Descriptor{kEndpoint, 0x80 | kStreamEndpoint, 2}.u16(512).u8(0).end(to);
}

}  // namespace

Bytes device_descriptor() {
  Bytes bytes;
  Descriptor{1}
      .u16(0x0200)
      .u8(0xef)
      .u8(2)
      .u8(1)
      .u8(64)
      .u16(0x1d6b)
      .u16(0x0102)
      .u16(0x0010)
      .u8(1)
      .u8(2)
      .u8(3)
      .u8(1)
      .end(bytes);
  return bytes;
}

Bytes configuration_descriptor() {
  Bytes bytes;
  Descriptor{kConfiguration}.u16(0).u8(2).u8(1).u8(0).u8(0x80).u8(250).end(bytes);
  Descriptor{kAssociation, kControlInterface, 2, kVideo, kVideoCollection, 0, 2}.end(bytes);
  control_interface(bytes);
  stream_interface(bytes);
  patch16(bytes, 2, bytes.size());
  return bytes;
}

Bytes string_descriptor(int number, const std::string& serial) {
  constexpr std::uint8_t kString = 3;
  constexpr std::uint32_t kEnglish = 0x0409;
  Descriptor descriptor{kString};
  if (number == 0) descriptor.u16(kEnglish);
  const std::string text = number == 1   ? "uvcsim"
                           : number == 2 ? "UVC Sim Camera"
                           : number == 3 ? serial
                                         : "";
  for (const char c : text) descriptor.u16(static_cast<std::uint8_t>(c));
  Bytes bytes;
  descriptor.end(bytes);
  return bytes;
}

}  // namespace stereod::uvcsim
