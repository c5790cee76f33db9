// A port of the kernel's virtual USB host controller (vhci-hcd).
#pragma once

#include <optional>

#include "tests/vm/uvcsim/usbip.h"

namespace stereod::uvcsim {

/// What is plugged in there speaks USB/IP over a socket with the kernel. One thread.
class UsbPort {
 public:
  UsbPort() = default;
  ~UsbPort() { unplug(); }
  UsbPort(const UsbPort&) = delete;
  UsbPort& operator=(const UsbPort&) = delete;

  /// Plugs in at port `number`, from 0; waits up to 5 s for what was plugged in before to be gone. Throws
  /// std::system_error.
  void plug(int number);
  void unplug();
  bool plugged() const { return socket_ >= 0; }
  int descriptor() const { return socket_; }

  /// The next message of the host's and the bytes that come with it; nothing once the kernel has hung up, and
  /// then it is unplugged. Call it when the descriptor is readable.
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
