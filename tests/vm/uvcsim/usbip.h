// SPDX-License-Identifier: BSD-3-Clause
// The USB/IP protocol between a device and the kernel's virtual host controller
// (Documentation/usb/usbip_protocol.rst).
#pragma once

#include <cstdint>
#include <optional>

#include "tests/vm/uvcsim/bytes.h"

namespace stereod::uvcsim {

constexpr std::size_t kUsbipHeader = 48;  // bytes, of every message

/// The eight bytes that begin every control transfer (USB 2.0, table 9-2).
struct SetupPacket {
  std::uint8_t type = 0;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
  std::uint16_t length = 0;
};

struct UsbipMessage {
  enum class Kind { kSubmit, kUnlink };
  Kind kind = Kind::kSubmit;
  std::uint32_t sequence = 0;
  std::uint32_t endpoint = 0;
  bool to_host = false;
  std::uint32_t length = 0;    ///< [bytes] of the transfer's buffer
  SetupPacket setup;           ///< for endpoint 0
  std::uint32_t unlinked = 0;  ///< sequence number of the request to cancel

  /// Returns the number of bytes that follow the header: the data that the host sends.
  std::uint32_t payload() const { return kind == Kind::kSubmit && !to_host ? length : 0; }
};

/// Parses a header of kUsbipHeader bytes. Returns nothing if it is neither a submit nor an unlink.
std::optional<UsbipMessage> parse_usbip(ByteSpan header);

/// Returns the answer to a submit. @p status: 0 or a negative errno value. @p transferred: number of bytes
/// that the host sent or that follow in @p data.
Bytes submit_reply(std::uint32_t sequence, int status, std::uint32_t transferred, ByteSpan data);

/// Returns the answer to an unlink. @p found: the request was still waiting.
Bytes unlink_reply(std::uint32_t sequence, bool found);

}  // namespace stereod::uvcsim
