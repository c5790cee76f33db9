// SPDX-License-Identifier: BSD-3-Clause
// Encoding and parsing of USB/IP.
#include "tests/vm/uvcsim/usbip.h"

#include <cerrno>

namespace stereod::uvcsim {
namespace {

constexpr std::uint32_t kSubmit = 1, kUnlink = 2, kSubmitReply = 3, kUnlinkReply = 4;

SetupPacket parse_setup(ByteSpan bytes) {
  const auto word = [bytes](std::size_t at) { return static_cast<std::uint16_t>(get_little(bytes, at, 2)); };
  return {bytes[0], bytes[1], word(2), word(4), word(6)};
}

// The kernel ignores device, direction and endpoint in an answer.
Bytes reply_header(std::uint32_t command, std::uint32_t sequence, int status, std::uint32_t transferred) {
  Bytes bytes;
  put_big(bytes, command);
  put_big(bytes, sequence);
  for (int i = 0; i < 3; ++i) put_big(bytes, 0);
  put_big(bytes, static_cast<std::uint32_t>(status));
  put_big(bytes, transferred);
  bytes.resize(kUsbipHeader);
  return bytes;
}

}  // namespace

std::optional<UsbipMessage> parse_usbip(ByteSpan header) {
  if (header.size() != kUsbipHeader) return std::nullopt;
  const std::uint32_t command = get_big(header, 0);
  UsbipMessage message;
  message.sequence = get_big(header, 4);
  message.to_host = get_big(header, 12) != 0;
  message.endpoint = get_big(header, 16);
  if (command == kSubmit) {
    message.length = get_big(header, 24);
    message.setup = parse_setup(header.subspan(40, 8));
    return message;
  }
  if (command == kUnlink) {
    message.kind = UsbipMessage::Kind::kUnlink;
    message.unlinked = get_big(header, 20);
    return message;
  }
  return std::nullopt;
}

Bytes submit_reply(std::uint32_t sequence, int status, std::uint32_t transferred, ByteSpan data) {
  Bytes bytes = reply_header(kSubmitReply, sequence, status, transferred);
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}

Bytes unlink_reply(std::uint32_t sequence, bool found) {
  return reply_header(kUnlinkReply, sequence, found ? -ECONNRESET : 0, 0);
}

}  // namespace stereod::uvcsim
