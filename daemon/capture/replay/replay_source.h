// Recorded pairs as two cameras.
#pragma once

#include <filesystem>
#include <memory>

#include "daemon/capture/frame_source.h"

namespace stereod {

struct ReplayOptions {
  double fps = 30;   ///< 0…1000; 0: as fast as the consumer gives frames back, none dropped
  bool loop = true;  ///< begin again after the last pair; else the sources finish
};

/// The two cameras of a replayed rig. They share one time: frames of the same number have the same capture
/// time. `sequence` counts from 0 and goes on counting when the recording begins again, so image n is the
/// recording's n modulo its length; with fps > 0 a consumer that is too slow sees gaps, as with a camera. The
/// recording is in memory and belongs to both; either source may live longer than the other.
struct ReplaySources {
  std::unique_ptr<FrameSource> left;
  std::unique_ptr<FrameSource> right;
};

/// Replays one pair of image files, or a directory of pairs: see Recording for what is found in it and what
/// is refused (FileError). Throws std::invalid_argument if fps is out of range.
ReplaySources open_replay(const std::filesystem::path& left, const std::filesystem::path& right,
                          const ReplayOptions& options);
ReplaySources open_replay(const std::filesystem::path& directory, const ReplayOptions& options);

}  // namespace stereod
