// SPDX-License-Identifier: BSD-3-Clause
// Writes etc/stereod.yaml and the manual page stereod.yaml(5) from the tables of options.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/option.h"

namespace stereod {

/// Describes an option and its default.
struct OptionReference {
  OptionInfo info;
  OptionValue default_value;
  bool commented = false;  ///< the shipped file has it in a comment
};

/// Describes a section of the configuration.
struct SectionReference {
  std::string_view path;         ///< "cameras.v4l2"; empty: keys outside of sections
  std::string_view description;  ///< sentences
  bool commented = false;        ///< the shipped file has it in a comment
  std::vector<OptionReference> options;
};

/// Returns all sections in the order of the manual.
std::vector<SectionReference> config_reference();

/// Returns the text of etc/stereod.yaml, which says the defaults.
std::string reference_yaml();

/// Returns the text of docs/man/stereod.yaml.5.
std::string reference_man_page();

}  // namespace stereod
