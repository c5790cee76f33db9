// SPDX-License-Identifier: BSD-3-Clause
// A recording as two cameras.
#pragma once

#include <filesystem>
#include <memory>

#include "daemon/capture/frame_source.h"

namespace stereod {

struct ReplayOptions {
  double fps = 30;   ///< [Hz, 0…1000]; 0 = as fast as the consumer gives frames back, no frame is dropped
  bool loop = true;  ///< start again after the last pair; else the sources finish
};

/// The two cameras of a recording. They share one clock (FrameClock): frames with the same number have the
/// same capture time. `sequence` counts from 0 across loops: frame n is the recording's pair n modulo its
/// length. With fps > 0 a consumer that is too slow sees gaps, as with a camera. The recording is in memory,
/// owned by both sources; either source may outlive the other one.
struct ReplaySources {
  std::unique_ptr<FrameSource> left;
  std::unique_ptr<FrameSource> right;
};

/// Replays one pair of image files, or a directory of pairs (see Recording).
/// @throws FileError as Recording does, std::invalid_argument if fps is out of range.
ReplaySources open_replay(const std::filesystem::path& left, const std::filesystem::path& right,
                          const ReplayOptions& options);
ReplaySources open_replay(const std::filesystem::path& directory, const ReplayOptions& options);

}  // namespace stereod
