// Strict reading of YAML: every key is known, every value has its type and range, every complaint has its
// line.
#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/file_error.h"

namespace stereod {

/// Reads a whole file as one YAML map. Throws FileError: missing, unreadable, not YAML (with the line), no
/// map.
YAML::Node load_yaml_map(const std::filesystem::path& file);

/// One map of a YAML file. Keys are read by asking for them; finish() then finds the ones nobody asked for.
/// All errors are FileErrors: "file:line: key: what was found, what is allowed".
class YamlSection {
 public:
  /// `path` is the section's own name with the names above it, "" for the whole file.
  YamlSection(std::filesystem::path file, const YAML::Node& map, std::string path = "")
      : YamlSection(std::move(file), map, std::move(path), map.Mark().line + 1) {}

  bool has(const std::string& key) const;

  /// The value of an optional key, `otherwise` if it is not there. Ranges are inclusive.
  int integer(const std::string& key, int otherwise, int least, int most);
  double number(const std::string& key, double otherwise, double least, double most);
  bool flag(const std::string& key, bool otherwise);
  std::string text(const std::string& key, const std::string& otherwise);
  /// A file's name; a relative one is relative to the directory of this file. Empty if the key is not there.
  std::filesystem::path file_name(const std::string& key);
  /// A value that `parse` knows; `allowed` lists all of them for the message.
  template <typename Value>
  Value choice(const std::string& key, Value otherwise, std::string_view allowed,
               const std::function<std::optional<Value>(std::string_view)>& parse) {
    const std::optional<std::string> found = scalar(key);
    if (!found) return otherwise;
    if (const std::optional<Value> value = parse(*found)) return *value;
    fail(key, "found '" + *found + "', allowed are " + std::string(allowed));
  }
  /// The same, but the key must be there.
  double required_number(const std::string& key, double least, double most);
  int required_integer(const std::string& key, int least, int most);
  std::string required_text(const std::string& key);
  /// A list of as many numbers as one of `counts` says.
  std::vector<double> required_numbers(const std::string& key, const std::vector<std::size_t>& counts);

  /// The whole numbers of the map below `key`, by their names; empty if it is not there.
  std::map<std::string, int> integers(const std::string& key);

  /// The map below `key`; an empty one if it is not there.
  YamlSection section(const std::string& key);
  /// The map below `key`, which must be there.
  YamlSection required_section(const std::string& key);

  /// Complains about the first key that was never asked for and names the nearest one that was.
  void finish() const;

  /// Throws the FileError about a key of this section, with the line of its value.
  [[noreturn]] void fail(const std::string& key, const std::string& complaint) const;

 private:
  YamlSection(std::filesystem::path file, const YAML::Node& map, std::string path, int line);
  std::optional<std::string> scalar(const std::string& key);
  int line_of(const std::string& key) const;  // 0 if it is not there
  YAML::Node find(const std::string& key);
  void require(const std::string& key);
  std::string full_name(const std::string& key) const;

  std::filesystem::path file_;
  YAML::Node map_;
  int line_ = 0;  // where the map stands, from 1; 0 if it stands nowhere
  std::string path_;
  std::vector<std::string> asked_for_;
};

/// The number of single-character insertions, deletions and replacements between two words.
std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace stereod
