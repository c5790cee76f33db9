// SPDX-License-Identifier: BSD-3-Clause
// Reads YAML strictly: unknown keys, wrong types and values out of range are errors with their line.
#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/option.h"
#include "daemon/base/file_error.h"

namespace stereod {

/// Reads a file of up to 1 MB as one YAML map.
/// @throws FileError if it is missing, unreadable, or not a YAML map (with the line).
YAML::Node load_yaml_map(const std::filesystem::path& file);

/// Reads one map of a YAML file. Keys become known by being asked for; finish() refuses the others.
/// All errors are FileErrors: "file:line: key: what was found, what is allowed".
class YamlSection {
 public:
  /// @p path is the name of the section with the sections above it, "" for the whole file.
  YamlSection(std::filesystem::path file, const YAML::Node& map, std::string path = "")
      : YamlSection(std::move(file), map, std::move(path), map.Mark().line + 1) {}

  bool has(const std::string& key) const;

  /// Returns the value of the option, nothing if the key is missing. A relative file name is relative to the directory
  /// of this file.
  std::optional<OptionValue> value(const OptionInfo& option);

  /// Reads all options of a table; those whose key is missing keep their values.
  template <typename Settings>
  void read(const std::vector<Option<Settings>>& table, Settings& settings) {
    for (const Option<Settings>& each : table) {
      if (const std::optional<OptionValue> found = value(each)) each.set(settings, *found);
    }
  }

  /// Return the value of a key, which must be there. Ranges are inclusive.
  double required_number(const std::string& key, double minimum, double maximum);
  int required_integer(const std::string& key, int minimum, int maximum);
  std::string required_text(const std::string& key);
  /// Returns the text of a key, empty if it is missing.
  std::string text(const std::string& key);
  /// Returns a list of numbers, whose length must be one of @p counts.
  std::vector<double> required_numbers(const std::string& key, const std::vector<std::size_t>& counts);

  /// Returns the map below @p key, an empty one if the key is missing.
  YamlSection section(const std::string& key);
  /// Returns the map below @p key, which must be there.
  YamlSection required_section(const std::string& key);

  /// Throws a FileError about the first key that was never asked for. It names the new name of a renamed key, else the
  /// nearest known key.
  void finish() const;

  /// Throws a FileError about a key of this section, with its line.
  [[noreturn]] void fail(const std::string& key, const std::string& complaint) const;

 private:
  YamlSection(std::filesystem::path file, const YAML::Node& map, std::string path, int line);
  std::optional<std::string> scalar(const std::string& key);
  NamedIntegers integers(const OptionInfo& option);
  int line_of(const std::string& key) const;  // 0 if the key is missing
  YAML::Node find(const std::string& key);
  void require(const std::string& key);
  std::string full_name(const std::string& key) const;

  std::filesystem::path file_;
  YAML::Node map_;
  int line_ = 0;  // of the map, from 1; 0 if the file lacks it
  std::string path_;
  std::vector<std::string> asked_for_;
};

/// Returns the number of single-character insertions, deletions and replacements between two words.
std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace stereod
