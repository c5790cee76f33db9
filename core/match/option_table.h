// SPDX-License-Identifier: BSD-3-Clause
// Lists the matcher's options with ranges, units and descriptions.
#pragma once

#include <vector>

#include "core/base/option.h"
#include "core/match/options.h"

namespace stereod {

/// Describes an option of the matcher. `only_with` names the method that has it.
using MatcherOption = Option<MatcherOptions>;

/// Returns all options in the order of the manual.
const std::vector<MatcherOption>& matcher_option_table();

inline constexpr std::string_view kDefaultMatcherPreset = "robust";

/// Describes the choice of a preset, which sets all options.
const OptionInfo& matcher_preset_option();

/// Returns whether @p method has the option.
bool belongs_to(const MatcherOption& option, Method method);

}  // namespace stereod
