// SPDX-License-Identifier: BSD-3-Clause
// Raw images from an LCM log as two cameras: replays what happened in the field.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "daemon/capture/frame_source.h"

namespace stereod {

struct LogReplayOptions {
  std::string prefix = "STEREO";  ///< of the log's channels PREFIX_LEFT_RAW and PREFIX_RIGHT_RAW
  bool original_pace = true;      ///< else as fast as the consumer gives frames back
  bool loop = false;              ///< start again after the last pair; else the sources finish
};

/// The two cameras of a log. Every frame has its exposure time from the log (Frame::utime), and left and
/// right frames are as far apart in time as they were. No frame is dropped: with the original pace, a
/// consumer that is too slow falls behind.
struct LogSources {
  std::unique_ptr<FrameSource> left, right;
  int pairs = 0;
  int unpaired = 0;  ///< images without a partner, and messages that are no 8-bit gray image
};

/// Reads the whole log into memory (see read_logged_pairs()). @throws FileError with one sentence.
LogSources open_log(const std::filesystem::path& file, const LogReplayOptions& options);

}  // namespace stereod
