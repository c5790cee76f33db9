// SPDX-License-Identifier: BSD-3-Clause
// The commands of a test to the simulated camera, as lines of text.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace stereod::uvcsim {

enum class Verb {
  kUnplug,    ///< unplug the camera
  kPlug,      ///< [PORT]: plug it in again, into another port if one is given
  kFreeze,    ///< stop delivering frames while plugged in
  kThaw,      ///< deliver frames again
  kRefuse,    ///< 1 or 0: refuse to start a stream
  kError,     ///< N frames with the error flag
  kTruncate,  ///< N images truncated in the middle
  kCorrupt,   ///< N JPEGs corrupted in the middle
  kResize,    ///< N JPEGs with another height than negotiated
  kPhase,     ///< [µs]: phase of the next stream in the frame period
  kDrift,     ///< [ppm]: by which the frame period is longer
  kLight,     ///< [%]: light on the scene
  kQuit,
};

struct Command {
  Verb verb = Verb::kQuit;
  std::optional<int> number;
};

/// Parses "VERB [NUMBER]". Returns nothing if the verb is unknown, or the number is missing or not allowed;
/// @p complaint then tells what is allowed.
std::optional<Command> parse_command(std::string_view line, std::string& complaint);

}  // namespace stereod::uvcsim
