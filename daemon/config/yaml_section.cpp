// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/config/yaml_section.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <system_error>

#include "daemon/base/file.h"
#include "daemon/config/renamed_keys.h"

namespace stereod {
namespace {

std::string kind_of(const YAML::Node& node) {
  if (node.IsMap()) return "a map";
  if (node.IsSequence()) return "a list";
  if (node.IsNull()) return "nothing";
  return "'" + node.Scalar() + "'";
}

}  // namespace

YAML::Node load_yaml_map(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error) && error) {
    throw FileError(file.string() + ": cannot be reached (" + error.message() +
                    "); give stereod access to its directory (as a service it has none to home directories)");
  }
  constexpr std::size_t kMaxYamlBytes = 1'000'000;
  const std::string text = read_text_file(file, kMaxYamlBytes);
  try {
    YAML::Node root = YAML::Load(text);
    if (!root.IsMap()) {
      throw FileError(file.string() + ":1: found " + kind_of(root).substr(0, 40) +
                      ", allowed a map of keys and values");
    }
    return root;
  } catch (const YAML::Exception& problem) {
    throw FileError(file.string() + ":" + std::to_string(problem.mark.line + 1) +
                    ": not valid YAML: " + problem.msg);
  }
}

YamlSection::YamlSection(std::filesystem::path file, const YAML::Node& map, std::string path, int line)
    : file_(std::move(file)), map_(map), line_(line), path_(std::move(path)) {
  std::vector<std::string> seen;
  for (const auto& entry : map_) {
    if (!entry.first.IsScalar()) {
      throw FileError(file_.string() + ":" + std::to_string(entry.first.Mark().line + 1) +
                      ": found a key that is not a word");
    }
    const std::string& key = entry.first.Scalar();
    if (std::find(seen.begin(), seen.end(), key) != seen.end()) {
      throw FileError(file_.string() + ":" + std::to_string(entry.first.Mark().line + 1) + ": " +
                      full_name(key) + ": is given twice; remove one of them");
    }
    seen.push_back(key);
  }
}

std::string YamlSection::full_name(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}

// map_[key] would add the key to a node that is not const.
YAML::Node YamlSection::find(const std::string& key) {
  asked_for_.push_back(key);
  for (const auto& entry : map_) {
    if (entry.first.Scalar() == key) return entry.second;
  }
  return YAML::Node(YAML::NodeType::Undefined);
}

bool YamlSection::has(const std::string& key) const {
  return std::any_of(map_.begin(), map_.end(),
                     [&](const auto& entry) { return entry.first.Scalar() == key; });
}

void YamlSection::require(const std::string& key) {
  if (!has(key)) {
    const std::string where = path_.empty() || line_ == 0 ? "" : ":" + std::to_string(line_);
    throw FileError(file_.string() + where + ": " + full_name(key) + ": is missing");
  }
}

int YamlSection::line_of(const std::string& key) const {
  for (const auto& entry : map_) {
    if (entry.first.Scalar() == key) return entry.first.Mark().line + 1;
  }
  return 0;
}

void YamlSection::fail(const std::string& key, const std::string& complaint) const {
  const int line = line_of(key);
  throw FileError(file_.string() + (line > 0 ? ":" + std::to_string(line) : "") + ": " + full_name(key) +
                  ": " + complaint);
}

std::optional<std::string> YamlSection::scalar(const std::string& key) {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return std::nullopt;
  if (!node.IsScalar()) fail(key, "found " + kind_of(node) + ", allowed one value");
  return node.Scalar();
}

std::optional<OptionValue> YamlSection::value(const OptionInfo& option) {
  const std::string key(option.key);
  if (option.type == OptionInfo::Type::kIntegers) {
    asked_for_.push_back(key);
    return has(key) ? std::optional<OptionValue>(integers(option)) : std::nullopt;
  }
  const std::optional<std::string> found = scalar(key);
  if (!found) return std::nullopt;
  if (option.type == OptionInfo::Type::kFile) {
    if (found->empty()) fail(key, complaint(option, *found));
    return (file_.parent_path() / *found).string();
  }
  if (std::optional<OptionValue> value = parse_value(option, *found)) return value;
  const std::string_view renamed = new_value(full_name(key), *found);
  fail(key, complaint(option, *found) +
                (renamed.empty() ? "" : "; '" + *found + "' is now '" + std::string(renamed) + "'"));
}

double YamlSection::required_number(const std::string& key, double minimum, double maximum) {
  require(key);
  return std::get<double>(
      *value({.key = key, .type = OptionInfo::Type::kNumber, .minimum = minimum, .maximum = maximum}));
}

int YamlSection::required_integer(const std::string& key, int minimum, int maximum) {
  require(key);
  return std::get<int>(*value({.key = key,
                               .type = OptionInfo::Type::kInteger,
                               .minimum = static_cast<double>(minimum),
                               .maximum = static_cast<double>(maximum)}));
}

std::string YamlSection::required_text(const std::string& key) {
  require(key);
  return text(key);
}

std::string YamlSection::text(const std::string& key) { return scalar(key).value_or(""); }

std::vector<double> YamlSection::required_numbers(const std::string& key,
                                                  const std::vector<std::size_t>& counts) {
  require(key);
  const YAML::Node node = find(key);
  if (!node.IsSequence() || std::find(counts.begin(), counts.end(), node.size()) == counts.end()) {
    std::string allowed;
    for (const std::size_t count : counts) allowed += (allowed.empty() ? "" : ", ") + std::to_string(count);
    fail(key, "found " + (node.IsSequence() ? std::to_string(node.size()) + " values" : kind_of(node)) +
                  ", allowed a list of numbers (" + allowed + ")");
  }
  std::vector<double> values;
  for (const YAML::Node& item : node) {
    const auto value = item.IsScalar() ? parse_number(item.Scalar()) : std::nullopt;
    if (!value) fail(key, "found " + kind_of(item) + ", allowed finite numbers");
    values.push_back(*value);
  }
  return values;
}

NamedIntegers YamlSection::integers(const OptionInfo& option) {
  YamlSection below = section(std::string(option.key));
  NamedIntegers values;
  for (const auto& entry : below.map_) {
    const std::string& name = entry.first.Scalar();
    values[name] =
        below.required_integer(name, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
  }
  return values;
}

YamlSection YamlSection::section(const std::string& key) {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return {file_, YAML::Node(YAML::NodeType::Map), full_name(key), 0};
  if (node.IsNull()) return {file_, YAML::Node(YAML::NodeType::Map), full_name(key), line_of(key)};
  if (!node.IsMap()) fail(key, "found " + kind_of(node) + ", allowed a map of keys and values");
  return {file_, node, full_name(key)};
}

YamlSection YamlSection::required_section(const std::string& key) {
  require(key);
  return section(key);
}

void YamlSection::finish() const {
  for (const auto& entry : map_) {
    const std::string& key = entry.first.Scalar();
    if (std::find(asked_for_.begin(), asked_for_.end(), key) != asked_for_.end()) continue;
    if (const std::string_view renamed = new_key(full_name(key)); !renamed.empty()) {
      fail(key, "is not a known key; it is now '" + std::string(renamed) + "'");
    }
    const auto nearest = std::min_element(
        asked_for_.begin(), asked_for_.end(),
        [&](const auto& a, const auto& b) { return edit_distance(key, a) < edit_distance(key, b); });
    const std::string hint =
        nearest == asked_for_.end() ? "" : "; the nearest known key is '" + *nearest + "'";
    fail(key, "is not a known key" + hint);
  }
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace stereod
