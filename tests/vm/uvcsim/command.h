// What a test tells the simulated camera, as lines of text.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace stereod::uvcsim {

enum class Verb {
  kUnplug,    ///< pull the plug
  kPlug,      ///< [PORT]: put it back, into another port if one is given
  kFreeze,    ///< fall silent without leaving the bus
  kThaw,      ///< end of that
  kRefuse,    ///< 1 or 0: refuse to start a stream
  kError,     ///< N frames with the error flag
  kTruncate,  ///< N images cut off in the middle
  kCorrupt,   ///< N JPEGs with rubbish in the middle
  kResize,    ///< N JPEGs that say another height than was agreed
  kPhase,     ///< µs: where in the frame time the next stream begins
  kDrift,     ///< parts in a million that frames come too late
  kLight,     ///< % of the light
  kQuit,
};

struct Command {
  Verb verb = Verb::kQuit;
  std::optional<int> number;
};

/// Reads "VERB [NUMBER]". Nothing if it is no command, lacks its number, or has one too many; `complaint`
/// then says what is allowed.
std::optional<Command> parse_command(std::string_view line, std::string& complaint);

}  // namespace stereod::uvcsim
