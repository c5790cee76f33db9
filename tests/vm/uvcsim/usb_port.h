// SPDX-License-Identifier: BSD-3-Clause
// A port of the kernel's virtual USB host controller (vhci-hcd).
#pragma once

#include <optional>

#include "tests/vm/uvcsim/usbip.h"

namespace stereod::uvcsim {

/// Plugs a simulated device into a port; the device speaks USB/IP with the kernel over a socket. One thread.
class UsbPort {
 public:
  UsbPort() = default;
  ~UsbPort() { unplug(); }
  UsbPort(const UsbPort&) = delete;
  UsbPort& operator=(const UsbPort&) = delete;

  /// Plugs in at port @p number [≥ 0]. Waits up to 5 s until the kernel has removed the previous device.
  /// @throws std::system_error
  void plug(int number);
  void unplug();
  bool plugged() const { return socket_ >= 0; }
  int descriptor() const { return socket_; }

  /// Returns the host's next message and its data. Returns nothing, and unplugs, when the kernel has closed
  /// the connection. Call it when the descriptor is readable.
  struct Received {
    UsbipMessage message;
    Bytes data;
  };
  std::optional<Received> receive();
  void send(ByteSpan bytes);

 private:
  bool read_all(std::uint8_t* to, std::size_t count);
  int socket_ = -1;
};

}  // namespace stereod::uvcsim
