// SPDX-License-Identifier: BSD-3-Clause
// Reads the section `matcher`.
#include <string>

#include "core/match/option_table.h"
#include "daemon/config/sections.h"

namespace stereod {

void read_matcher_section(YamlSection section, MatcherOptions& options) {
  const OptionInfo& preset = matcher_preset_option();
  if (const auto name = section.value(preset)) options = *matcher_preset(std::get<std::string>(*name));
  section.read(matcher_option_table(), options);
  // A key of the method that is not selected is more likely a mistake than a wish.
  for (const MatcherOption& option : matcher_option_table()) {
    const std::string key(option.key);
    if (!belongs_to(option, options.method) && section.has(key)) {
      section.fail(key, "belongs to " + std::string(option.only_with) + ", but the method is " +
                            std::string(name_of(options.method)));
    }
  }
  section.finish();
  if (const auto problem = problem_with(options)) section.fail(problem->key, problem->message);
}

}  // namespace stereod
