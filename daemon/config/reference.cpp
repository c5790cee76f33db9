// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/config/reference.h"

#include <algorithm>
#include <cctype>

#include "core/match/option_table.h"
#include "daemon/base/text.h"
#include "daemon/config/sections.h"

namespace stereod {
namespace {

constexpr std::size_t kLineWidth = 120;

template <typename Settings>
std::vector<OptionReference> rows_of(const Options<Settings>& table) {
  std::vector<OptionReference> rows;
  for (const Option<Settings>& option : table) {
    // An option with an example has no default that could be written.
    const bool commented = !option.example.empty() && !option.required;
    rows.push_back({option, option.get(Settings{}), commented});
  }
  return rows;
}

std::vector<OptionReference> matcher_rows() {
  std::vector<OptionReference> rows{{matcher_preset_option(), std::string(kDefaultMatcherPreset)}};
  const MatcherOptions robust = *matcher_preset("robust"), fast = *matcher_preset("fast");
  for (const MatcherOption& option : matcher_option_table()) {
    const bool commented = option.key != "min_disparity" && option.key != "disparities";
    rows.push_back({option, option.get(belongs_to(option, robust.method) ? robust : fast), commented});
  }
  return rows;
}

bool is_text(const OptionInfo& option) { return option.type == OptionInfo::Type::kText; }

/// Returns the value for the file: the example where there is no default.
std::string shown_value(const OptionReference& option) {
  std::string text = option.info.example.empty() ? value_text(option.info, option.default_value)
                                                 : std::string(option.info.example);
  return is_text(option.info) && text.empty() ? "\"\"" : text;
}

/// Returns ", default 0 = half a frame period, only with method: block".
std::string conditions(const OptionReference& option) {
  if (option.info.required) return ", required";
  std::string text;
  const bool has_default = option.info.example.empty();
  if (has_default) text += ", default " + shown_value(option);
  if (!option.info.default_name.empty()) {
    text += has_default ? " = " : ", default: ";
    text += option.info.default_name;
  }
  if (!option.info.only_with.empty()) text += ", only with " + std::string(option.info.only_with);
  return text;
}

std::string name_of_section(std::string_view path) {
  return std::string(path.substr(path.rfind('.') == path.npos ? 0 : path.rfind('.') + 1));
}

/// Appends text as a comment, broken at spaces.
void append_comment(std::string& yaml, const std::string& indent, std::string_view text) {
  for (const std::string& line : wrapped(text, kLineWidth - indent.size() - 2)) {
    yaml.append(indent).append("# ").append(line).append("\n");
  }
}

void append_section(std::string& yaml, const SectionReference& section) {
  const auto depth = static_cast<std::size_t>(std::count(section.path.begin(), section.path.end(), '.'));
  const std::string outer(2 * depth, ' ');
  const std::string off = section.commented ? "# " : "";
  std::string inner = outer;
  if (!section.path.empty()) {
    if (!section.description.empty()) append_comment(yaml, outer, section.description);
    yaml += outer + off + name_of_section(section.path) + ":\n";
    inner += off + "  ";
  }
  bool first = true;
  for (const OptionReference& option : section.options) {
    if (!first) yaml += section.commented ? outer + "#\n" : "\n";
    first = false;
    append_comment(yaml, inner, range_text(option.info) + conditions(option));
    append_comment(yaml, inner, option.info.description);
    yaml += inner + (option.commented && !section.commented ? "# " : "") + std::string(option.info.key) +
            ": " + shown_value(option) + "\n";
  }
  yaml += "\n";
}

/// Returns text for roff: a hyphen-minus stays one, a line does not begin with a control character.
std::string roff(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else {
      if ((c == '.' || c == '\'') && (result.empty() || result.back() == '\n')) result += "\\&";
      result += c;
    }
  }
  return result;
}

}  // namespace

std::vector<SectionReference> config_reference() {
  return {
      {"cameras", "", false, rows_of(cameras_options())},
      {"cameras.v4l2", "For source: v4l2. The daemon waits for missing cameras and reopens lost ones.", false,
       rows_of(v4l2_options())},
      {"cameras.replay", "For source: replay.", true, rows_of(replay_options())},
      {"cameras.log", "For source: log.", true, rows_of(log_source_options())},
      {"cameras.synthetic", "For source: synthetic.", false, rows_of(synthetic_options())},
      {"", "", false, rows_of(root_options())},
      {"rectify", "", false, rows_of(rectify_options())},
      {"matcher",
       "The defaults below are those of preset: robust. For keys that exist only with method: block they are those of "
       "preset: fast.",
       false, matcher_rows()},
      {"scheduling",
       "How the kernel runs the matching threads. Both keys need permissions of the systemd unit: install "
       "/usr/share/doc/stereod/examples/realtime.conf. Without them the threads run with normal scheduling, and the log "
       "and the status say so.",
       false, rows_of(scheduling_options())},
      {"lcm", "", false, rows_of(lcm_options())},
      {"publish", "Which part of the disparity image is published, and what is derived from it.", false,
       rows_of(publish_options())},
      {"publish.region",
       "Part of the rectified image that is published. Pixels outside are not matched, which saves time; the obstacle scan "
       "sees only this part.",
       false, rows_of(region_options())},
      {"scan", "", false, rows_of(scan_options())},
      {"log", "", false, rows_of(log_options())},
  };
}

std::string reference_yaml() {
  std::string yaml =
      "# SPDX-License-Identifier: BSD-3-Clause\n"
      "# Configuration of stereod: every key with its unit, range and default. A key in a comment is optional: it has no\n"
      "# default value, or it replaces one setting of the preset. An unknown key or a value out of range ends the start with\n"
      "# the line, the value found and the values allowed. Check a change with\n"
      "#   stereod --check-config --config FILE\n\n";
  for (const SectionReference& section : config_reference()) append_section(yaml, section);
  yaml.pop_back();
  return yaml;
}

std::string reference_man_page() {
  std::string page =
      ".\\\" SPDX-License-Identifier: BSD-3-Clause\n"
      ".\\\" Written by write_reference from the tables of options.\n"
      ".TH STEREOD.YAML 5 \"\" stereod \"File formats\"\n"
      ".SH NAME\n"
      "stereod.yaml \\- configuration of stereod\n"
      ".SH DESCRIPTION\n"
      ".BR stereod (8)\n"
      "reads\n"
      ".IR /etc/stereod/stereod.yaml ,\n"
      "a map of sections and keys in YAML.\n"
      "Every key but\n"
      ".B cameras.source\n"
      "may be left out and then has its default.\n"
      "An unknown key, a wrong type or a value out of range ends the start with the file, the line, the key, the value found\n"
      "and the values allowed, and with exit status 78.\n"
      ".B stereod \\-\\-check\\-config\n"
      "checks a file without starting.\n"
      "The installed file contains every key: with its default, or as a comment.\n"
      ".SH KEYS\n";
  for (const SectionReference& section : config_reference()) {
    page += section.path.empty() ? ".SS Keys outside of sections\n" : ".SS " + roff(section.path) + "\n";
    if (!section.description.empty()) page += roff(section.description) + "\n";
    for (const OptionReference& option : section.options) {
      page += ".TP\n.B " + roff(option.info.key) + "\n" + roff(range_text(option.info) + conditions(option)) +
              "\n.br\n" + roff(option.info.description) + "\n";
    }
  }
  page +=
      ".SH EXAMPLE\n"
      "Two webcams, distances up to 3 m, an obstacle scan:\n"
      ".PP\n"
      ".EX\n"
      "cameras:\n"
      "  source: v4l2\n"
      "calibration: calibration.yaml\n"
      "scan: {enabled: true, ground: estimate}\n"
      ".EE\n"
      ".SH SEE ALSO\n"
      ".BR stereod (8),\n"
      ".BR stereo\\-match (1),\n"
      ".BR stereo\\-calibrate (1)\n";
  return page;
}

}  // namespace stereod
