// SPDX-License-Identifier: BSD-3-Clause
// The frames in a log of stereod's messages.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "daemon/client/stereod_client.h"
#include "daemon/lcm/log.h"

namespace stereod {

/// Returns the complete frames of a log by their utime.
inline std::map<std::int64_t, StereoFrame> frames_of(const std::filesystem::path& file,
                                                     const std::string& prefix) {
  std::map<std::int64_t, StereoFrame> frames;
  const auto client = StereoClient::unconnected();
  client->on_frame([&](StereoFrame&& frame) {
    if (frame.complete()) frames.emplace(frame.utime, std::move(frame));
  });
  LcmLogReader reader(file);
  for (LogEvent event; reader.next(event);) {
    if (event.channel == prefix + "_DISPARITY") client->take_rows(event.data.data(), event.data.size());
    if (event.channel == prefix + "_FRAME") client->take_frame(event.data.data(), event.data.size());
    if (event.channel == prefix + "_CAMERA_INFO")
      client->take_camera_info(event.data.data(), event.data.size());
  }
  return frames;
}

}  // namespace stereod
