// SPDX-License-Identifier: BSD-3-Clause
// Control requests, streaming, and damage on command.
#include "tests/vm/uvcsim/webcam.h"

#include <algorithm>
#include <cerrno>

#include "tests/vm/uvcsim/descriptors.h"

namespace stereod::uvcsim {
namespace {

// Fields and values of setup packets (USB 2.0, 9.3 and 9.4; USB Video Class 1.0, 4.2 and 4.3).
constexpr std::uint8_t kToHost = 0x80, kTypeMask = 0x60, kStandard = 0x00, kClass = 0x20;
constexpr std::uint8_t kGetStatus = 0, kClearFeature = 1, kSetFeature = 3, kSetAddress = 5,
                       kGetDescriptor = 6, kGetConfiguration = 8, kSetConfiguration = 9, kGetInterface = 10,
                       kSetInterface = 11;
constexpr std::uint8_t kDevice = 1, kConfiguration = 2, kString = 3;
constexpr std::uint8_t kRecipientMask = 0x1f, kToEndpoint = 2;
constexpr std::uint8_t kProbe = 1, kCommit = 2;  // selectors of the stream interface
constexpr std::uint8_t kErrorCode = 2;           // selector of the control interface itself
constexpr std::uint8_t kEndOfHeader = 0x80, kError = 0x40, kEndOfFrame = 0x02;

}  // namespace

Webcam::Webcam(const WebcamOptions& options) : options_(options), images_(options.eye) { plug(); }

void Webcam::plug() {
  stop();
  controls_ = Controls();  // a camera forgets its controls when it is unplugged
  port_.plug(options_.port);
}

void Webcam::stop() {
  streaming_ = sending_ = false;
  waiting_.clear();
}

bool Webcam::obey(const Command& command) {
  switch (command.verb) {
    case Verb::kUnplug:
      stop();
      port_.unplug();
      break;
    case Verb::kPlug:
      options_.port = command.number.value_or(options_.port);
      plug();
      break;
    case Verb::kFreeze:
    case Verb::kThaw:
      frozen_ = command.verb == Verb::kFreeze;
      break;
    case Verb::kRefuse:
      refusing_ = *command.number != 0;
      break;
    case Verb::kError:
    case Verb::kTruncate:
    case Verb::kCorrupt:
    case Verb::kResize:
      damage_ = {command.verb, *command.number};
      break;
    case Verb::kPhase:
      shutter_.set_phase(std::int64_t{*command.number} * 1000);
      break;
    case Verb::kDrift:
      shutter_.set_drift(*command.number);
      break;
    case Verb::kLight:
      controls_.set_light(*command.number);
      break;
    case Verb::kQuit:
      return false;
  }
  return true;
}

void Webcam::handle(std::int64_t now_ns) {
  const auto received = port_.receive();
  if (!received) return stop();
  const UsbipMessage& message = received->message;
  if (message.kind == UsbipMessage::Kind::kUnlink) {
    unlink(message);
  } else if (message.endpoint == 0) {
    handle_control(message, received->data, now_ns);
  } else {
    waiting_.push_back({message.sequence, message.length});
    send_waiting();
  }
}

void Webcam::unlink(const UsbipMessage& message) {
  const auto request = std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& waiting) {
    return waiting.sequence == message.unlinked;
  });
  const bool found = request != waiting_.end();
  if (found) waiting_.erase(request);
  port_.send(unlink_reply(message.sequence, found));
}

void Webcam::handle_control(const UsbipMessage& message, ByteSpan data, std::int64_t now_ns) {
  const SetupPacket& setup = message.setup;
  const std::uint8_t type = setup.type & kTypeMask;
  std::optional<Bytes> answer;
  if (type == kStandard) answer = standard_request(setup);
  if (type == kClass) answer = class_request(setup, data, now_ns);
  if (!answer) {
    port_.send(submit_reply(message.sequence, -EPIPE, 0, {}));  // a stall
  } else if ((setup.type & kToHost) != 0) {
    if (answer->size() > setup.length) answer->resize(setup.length);
    port_.send(submit_reply(message.sequence, 0, static_cast<std::uint32_t>(answer->size()), *answer));
  } else {
    port_.send(submit_reply(message.sequence, 0, static_cast<std::uint32_t>(data.size()), {}));
  }
}

std::optional<Bytes> Webcam::standard_request(const SetupPacket& setup) {
  switch (setup.request) {
    case kGetDescriptor:
      if (setup.value >> 8 == kDevice) return device_descriptor();
      if (setup.value >> 8 == kConfiguration) return configuration_descriptor();
      if (setup.value >> 8 == kString) return string_descriptor(setup.value & 0xff, options_.serial);
      return std::nullopt;
    case kGetStatus:
      return Bytes{0, 0};
    case kGetConfiguration:
      return Bytes{1};
    case kGetInterface:
      return Bytes{0};
    case kClearFeature:  // ends a bulk stream
      if ((setup.type & kRecipientMask) == kToEndpoint) streaming_ = sending_ = false;
      return Bytes{};
    case kSetFeature:
    case kSetAddress:
    case kSetConfiguration:
    case kSetInterface:
      return Bytes{};
    default:
      return std::nullopt;
  }
}

std::optional<Bytes> Webcam::class_request(const SetupPacket& setup, ByteSpan data, std::int64_t now_ns) {
  const auto interface = static_cast<std::uint8_t>(setup.index);
  const auto unit = static_cast<std::uint8_t>(setup.index >> 8);
  const auto selector = static_cast<std::uint8_t>(setup.value >> 8);
  if (interface == kStreamInterface) return stream_request(setup, data, now_ns);
  if (unit == 0 && selector == kErrorCode) return Bytes{controls_.error_code()};
  return controls_.answer(static_cast<ControlRequest>(setup.request), unit, selector, data);
}

std::optional<Bytes> Webcam::stream_request(const SetupPacket& setup, ByteSpan data, std::int64_t now_ns) {
  const auto selector = static_cast<std::uint8_t>(setup.value >> 8);
  if (selector != kProbe && selector != kCommit) return std::nullopt;
  switch (static_cast<ControlRequest>(setup.request)) {
    case ControlRequest::kSetCurrent:
      if (selector == kProbe) {
        probed_ = negotiated(data);
      } else {
        if (refusing_) return std::nullopt;
        format_ = negotiated(data);
        images_.prepare(format_, controls_.gain_64(), controls_.offset());
        shutter_.start(now_ns, std::int64_t{format_.frame_time} * 100);
        streaming_ = true;
      }
      return Bytes{};
    case ControlRequest::kGetLength:
      return Bytes{kNegotiationBytes, 0};
    case ControlRequest::kGetInfo:
      return Bytes{3};
    default:
      return negotiation_bytes(selector == kProbe ? probed_ : format_);
  }
}

std::optional<std::int64_t> Webcam::due_ns() const {
  return streaming_ ? std::optional<std::int64_t>(shutter_.due_ns()) : std::nullopt;
}

// A frame without a waiting request is lost, as in a real camera.
void Webcam::expose(std::int64_t now_ns) {
  if (!streaming_ || now_ns < shutter_.due_ns()) return;
  if (!frozen_ && !sending_ && !waiting_.empty()) begin_frame();
  shutter_.advance(now_ns);
  send_waiting();
}

void Webcam::begin_frame() {
  frame_bytes_ = images_.get(format_, shutter_.frame(), controls_.gain_64(), controls_.offset());
  marked_bad_ = false;
  if (damage_.frames > 0) {
    --damage_.frames;
    if (damage_.kind == Verb::kError) marked_bad_ = true;
    if (damage_.kind == Verb::kTruncate) frame_bytes_.resize(frame_bytes_.size() / 2);
    if (damage_.kind == Verb::kCorrupt) corrupt_jpeg(frame_bytes_);
    if (damage_.kind == Verb::kResize) change_jpeg_height(frame_bytes_, 16);
  }
  sent_ = 0;
  sending_ = true;
  frame_id_ ^= 1;
}

void Webcam::send_waiting() {
  constexpr std::size_t kHeader = 2;
  while (sending_ && !waiting_.empty()) {
    const Waiting request = waiting_.front();
    waiting_.pop_front();
    const std::size_t room = std::min<std::size_t>(request.length, kPayloadBytes) - kHeader;
    const std::size_t count = std::min(room, frame_bytes_.size() - sent_);
    const bool last = sent_ + count == frame_bytes_.size();
    Bytes payload{kHeader, static_cast<std::uint8_t>(kEndOfHeader | frame_id_ | (marked_bad_ ? kError : 0) |
                                                     (last ? kEndOfFrame : 0))};
    const auto from = frame_bytes_.begin() + static_cast<std::ptrdiff_t>(sent_);
    payload.insert(payload.end(), from, from + static_cast<std::ptrdiff_t>(count));
    sent_ += count;
    sending_ = !last;
    port_.send(submit_reply(request.sequence, 0, static_cast<std::uint32_t>(payload.size()), payload));
  }
}

}  // namespace stereod::uvcsim
