// SPDX-License-Identifier: BSD-3-Clause
// The simulated camera itself.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "tests/vm/uvcsim/command.h"
#include "tests/vm/uvcsim/controls.h"
#include "tests/vm/uvcsim/scene_images.h"
#include "tests/vm/uvcsim/shutter.h"
#include "tests/vm/uvcsim/usb_port.h"

namespace stereod::uvcsim {

struct WebcamOptions {
  int port = 0;
  std::string serial = "0001";
  Eye eye = Eye::kLeft;
};

/// A webcam with MJPEG and YUYV, plugged into a virtual port. Times are CLOCK_MONOTONIC [ns]. One thread
/// calls handle() when the port's descriptor is readable, expose() when a frame is due, and obey() for
/// commands.
class Webcam {
 public:
  explicit Webcam(const WebcamOptions& options);

  /// Returns -1 while unplugged.
  int descriptor() const { return port_.descriptor(); }
  void handle(std::int64_t now_ns);

  /// Returns when the next frame is due; nothing while the camera does not stream.
  std::optional<std::int64_t> due_ns() const;
  void expose(std::int64_t now_ns);

  /// Executes a command. Returns false if the program is to end. @throws std::system_error if a port is not
  /// available.
  bool obey(const Command& command);

 private:
  void handle_control(const UsbipMessage& message, ByteSpan data, std::int64_t now_ns);
  std::optional<Bytes> standard_request(const SetupPacket& setup);
  std::optional<Bytes> class_request(const SetupPacket& setup, ByteSpan data, std::int64_t now_ns);
  std::optional<Bytes> stream_request(const SetupPacket& setup, ByteSpan data, std::int64_t now_ns);
  void unlink(const UsbipMessage& message);
  void begin_frame();
  void send_waiting();
  void stop();
  void plug();

  struct Waiting {
    std::uint32_t sequence, length;
  };
  struct Damage {
    Verb kind = Verb::kError;
    int frames = 0;
  };

  WebcamOptions options_;
  Controls controls_;
  SceneImages images_;
  Shutter shutter_;
  UsbPort port_;
  StreamFormat probed_, format_;
  bool streaming_ = false, frozen_ = false, refusing_ = false;
  Damage damage_;
  std::deque<Waiting> waiting_;  // the kernel's requests for payloads
  Bytes frame_bytes_;            // the frame that is being sent
  std::size_t sent_ = 0;
  bool sending_ = false, marked_bad_ = false;
  std::uint8_t frame_id_ = 0;  // alternates, so that the host recognizes the begin of a frame
};

}  // namespace stereod::uvcsim
