#include "daemon/config/yaml_section.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>
#include <system_error>

#include "core/base/text.h"
#include "daemon/base/file.h"

namespace stereod {
namespace {

template <typename Number>
std::optional<Number> parse_number(const std::string& text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

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
      throw FileError(file.string() + ":1: expected a map of keys and values, found " +
                      kind_of(root).substr(0, 40));
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
                      ": a key must be a word");
    }
    const std::string& key = entry.first.Scalar();
    if (std::find(seen.begin(), seen.end(), key) != seen.end()) {
      throw FileError(file_.string() + ":" + std::to_string(entry.first.Mark().line + 1) + ": " +
                      full_name(key) + ": stands here a second time; keep one of them");
    }
    seen.push_back(key);
  }
}

std::string YamlSection::full_name(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}

// Does not use map_[key]: on a node that is not const it would add the key.
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
  if (!node.IsScalar()) fail(key, "found " + kind_of(node) + ", allowed is one value");
  return node.Scalar();
}

int YamlSection::integer(const std::string& key, int otherwise, int least, int most) {
  const auto found = scalar(key);
  if (!found) return otherwise;
  const auto value = parse_number<int>(*found);
  if (!value || *value < least || *value > most) {
    fail(key, "found '" + *found + "', allowed are whole numbers from " + std::to_string(least) + " to " +
                  std::to_string(most));
  }
  return *value;
}

double YamlSection::number(const std::string& key, double otherwise, double least, double most) {
  const auto found = scalar(key);
  if (!found) return otherwise;
  const auto value = parse_number<double>(*found);
  if (!value || !std::isfinite(*value) || *value < least || *value > most) {
    fail(key, "found '" + *found + "', allowed are numbers from " + significant(least) + " to " +
                  significant(most));
  }
  return *value;
}

bool YamlSection::flag(const std::string& key, bool otherwise) {
  return choice<bool>(key, otherwise, "true and false", [](std::string_view text) -> std::optional<bool> {
    if (text == "true") return true;
    if (text == "false") return false;
    return std::nullopt;
  });
}

std::string YamlSection::text(const std::string& key, const std::string& otherwise) {
  return scalar(key).value_or(otherwise);
}

std::filesystem::path YamlSection::file_name(const std::string& key) {
  const auto found = scalar(key);
  if (!found) return {};
  if (found->empty()) fail(key, "found nothing, allowed is the name of a file");
  return file_.parent_path() / *found;
}

double YamlSection::required_number(const std::string& key, double least, double most) {
  require(key);
  return number(key, 0, least, most);
}

int YamlSection::required_integer(const std::string& key, int least, int most) {
  require(key);
  return integer(key, 0, least, most);
}

std::string YamlSection::required_text(const std::string& key) {
  require(key);
  return text(key, "");
}

std::vector<double> YamlSection::required_numbers(const std::string& key,
                                                  const std::vector<std::size_t>& counts) {
  require(key);
  const YAML::Node node = find(key);
  if (!node.IsSequence() || std::find(counts.begin(), counts.end(), node.size()) == counts.end()) {
    std::string allowed;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (i > 0) allowed += i + 1 < counts.size() ? ", " : " or ";
      allowed += std::to_string(counts[i]);
    }
    fail(key, "found " + (node.IsSequence() ? std::to_string(node.size()) + " values" : kind_of(node)) +
                  ", allowed is a list of " + allowed + " numbers");
  }
  std::vector<double> values;
  for (const YAML::Node& item : node) {
    const auto value = item.IsScalar() ? parse_number<double>(item.Scalar()) : std::nullopt;
    if (!value || !std::isfinite(*value))
      fail(key, "found " + kind_of(item) + ", allowed are finite numbers");
    values.push_back(*value);
  }
  return values;
}

std::map<std::string, int> YamlSection::integers(const std::string& key) {
  YamlSection below = section(key);
  std::map<std::string, int> values;
  for (const auto& entry : below.map_) {
    const std::string& name = entry.first.Scalar();
    values[name] = below.integer(name, 0, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
  }
  return values;
}

YamlSection YamlSection::section(const std::string& key) {
  const YAML::Node node = find(key);
  if (!node.IsDefined()) return {file_, YAML::Node(YAML::NodeType::Map), full_name(key), 0};
  if (node.IsNull()) return {file_, YAML::Node(YAML::NodeType::Map), full_name(key), line_of(key)};
  if (!node.IsMap()) fail(key, "found " + kind_of(node) + ", allowed is a map of keys and values");
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
