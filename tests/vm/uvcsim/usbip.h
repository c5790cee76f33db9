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
  std::uint32_t length = 0;    ///< of the transfer's buffer
  SetupPacket setup;           ///< for endpoint 0
  std::uint32_t unlinked = 0;  ///< the sequence number to forget

  /// Bytes that follow the header: what the host sends.
  std::uint32_t payload() const { return kind == Kind::kSubmit && !to_host ? length : 0; }
};

/// Reads a header of kUsbipHeader bytes; nothing if it is neither a submit nor an unlink.
std::optional<UsbipMessage> parse_usbip(ByteSpan header);

/// The answer to a submit: `status` 0 or a negative errno; `transferred` counts what the host sent or `data`,
/// which follows if it goes to the host.
Bytes submit_reply(std::uint32_t sequence, int status, std::uint32_t transferred, ByteSpan data);

/// The answer to an unlink: whether the request was still waiting.
Bytes unlink_reply(std::uint32_t sequence, bool found);

}  // namespace stereod::uvcsim
