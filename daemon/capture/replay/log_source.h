// Raw images from an LCM log as two cameras: what went wrong in the field, on the desk.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "daemon/capture/frame_source.h"

namespace stereod {

struct LogReplayOptions {
  std::string prefix = "STEREO";  ///< of the channels in the log: PREFIX_LEFT_RAW and PREFIX_RIGHT_RAW
  bool original_pace = true;      ///< false: as fast as the consumer gives frames back
  bool loop = false;              ///< begin again after the last pair; else the sources finish
};

/// The two cameras of a log. Every frame has the time of its exposure as the log says it (Frame::utime), and
/// left and right are as far apart in time as they were. None is ever dropped: with the original pace a
/// consumer that is too slow falls behind.
struct LogSources {
  std::unique_ptr<FrameSource> left, right;
  int pairs = 0;
  int unpaired = 0;  ///< images whose partner is not in the log
};

/// Reads the whole log into memory. Throws FileError with a sentence: no log, no pair of images in it, images
/// of different sizes, more than 4 GiB of them (1 GiB on 32-bit machines).
LogSources open_log(const std::filesystem::path& file, const LogReplayOptions& options);

}  // namespace stereod
