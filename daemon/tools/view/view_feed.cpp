// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/view/view_feed.h"

#include <span>
#include <utility>

#include "daemon/lcm/message_decoder.h"

namespace stereod::tools {
namespace {

StereoClient::Options client_options(const LcmReceiver& receiver, const std::string& prefix) {
  StereoClient::Options options;
  options.url = receiver.url();
  options.prefix = prefix;
  return options;
}

}  // namespace

ViewFeed::ViewFeed(const std::string& lcm_url, const std::string& prefix, LiveView& view)
    : others_(lcm_url), frames_(client_options(others_, prefix)) {
  frames_.on_frame([this, &view](StereoFrame&& frame) {
    receive_others();  // the scan of the frame was sent before its summary
    view.take(std::move(frame), frames_.counts());
  });
  others_.subscribe(prefix + "_STATUS", [&view](std::span<const std::byte> bytes) {
    status_t status;
    if (decode_message(bytes, status)) view.take(std::move(status));
  });
  others_.subscribe(prefix + "_SCAN", [&view](std::span<const std::byte> bytes) {
    planar_lidar_t scan;
    if (decode_message(bytes, scan)) view.take(std::move(scan));
  });
  others_.subscribe(prefix + "_LEFT", [&view](std::span<const std::byte> bytes) {
    image_t image;
    if (decode_message(bytes, image)) view.take(image);
  });
}

void ViewFeed::receive_others() {
  constexpr int kMaxMessages = 100;  // then frames are handled
  for (int i = 0; i < kMaxMessages && others_.receive(std::chrono::milliseconds(0)); ++i) {
  }
}

void ViewFeed::run_once() {
  receive_others();
  frames_.handle(20);
}

}  // namespace stereod::tools
