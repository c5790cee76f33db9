// SPDX-License-Identifier: BSD-3-Clause
// Parsing of commands.
#include "tests/vm/uvcsim/command.h"

#include <array>
#include <charconv>

namespace stereod::uvcsim {
namespace {

enum class Number { kNone, kOptional, kNeeded };

struct Word {
  std::string_view text;
  Verb verb;
  Number number;
};

constexpr std::array<Word, 13> kWords{{{"unplug", Verb::kUnplug, Number::kNone},
                                       {"plug", Verb::kPlug, Number::kOptional},
                                       {"freeze", Verb::kFreeze, Number::kNone},
                                       {"thaw", Verb::kThaw, Number::kNone},
                                       {"refuse", Verb::kRefuse, Number::kNeeded},
                                       {"error", Verb::kError, Number::kNeeded},
                                       {"truncate", Verb::kTruncate, Number::kNeeded},
                                       {"corrupt", Verb::kCorrupt, Number::kNeeded},
                                       {"resize", Verb::kResize, Number::kNeeded},
                                       {"phase", Verb::kPhase, Number::kNeeded},
                                       {"drift", Verb::kDrift, Number::kNeeded},
                                       {"light", Verb::kLight, Number::kNeeded},
                                       {"quit", Verb::kQuit, Number::kNone}}};

std::optional<int> parse_number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional<int>(value) : std::nullopt;
}

std::string allowed_words() {
  std::string all;
  for (const Word& word : kWords) all += (all.empty() ? "" : ", ") + std::string(word.text);
  return all;
}

}  // namespace

std::optional<Command> parse_command(std::string_view line, std::string& complaint) {
  const std::size_t space = line.find(' ');
  const std::string_view verb = line.substr(0, space);
  const std::string_view rest = space == std::string_view::npos ? "" : line.substr(space + 1);
  const std::string found = "found '" + std::string(line) + "', ";
  for (const Word& word : kWords) {
    if (word.text != verb) continue;
    const std::optional<int> number = parse_number(rest);
    if (!rest.empty() && (!number || word.number == Number::kNone)) {
      complaint = found + "allowed after " + std::string(verb) +
                  (word.number == Number::kNone ? " is nothing" : " is a whole number");
      return std::nullopt;
    }
    if (word.number == Number::kNeeded && !number) {
      complaint = found + std::string(verb) + " needs a whole number";
      return std::nullopt;
    }
    return Command{word.verb, number};
  }
  complaint = found + "allowed are " + allowed_words();
  return std::nullopt;
}

}  // namespace stereod::uvcsim
