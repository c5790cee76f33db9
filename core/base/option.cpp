// SPDX-License-Identifier: BSD-3-Clause
#include "core/base/option.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "core/base/text.h"

namespace stereod {
namespace {

using Type = OptionInfo::Type;

template <typename Number>
std::optional<Number> parse(std::string_view text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

bool in_range(const OptionInfo& option, double value) {
  return std::isfinite(value) && value >= option.minimum && value <= option.maximum;
}

bool allows_integer(const OptionInfo& option, int value) {
  if (!option.only.empty()) {
    return std::find(option.only.begin(), option.only.end(), value) != option.only.end();
  }
  return in_range(option, value) && (!option.odd || value % 2 != 0);
}

std::string integer_list(const OptionInfo& option, std::string_view separator) {
  std::string list;
  for (const int value : option.only)
    list.append(list.empty() ? "" : separator).append(std::to_string(value));
  return list;
}

/// Returns the range of a number without its unit.
std::string number_range(const OptionInfo& option) {
  if (!option.only.empty()) return integer_list(option, ", ");
  // More digits than six, so that a large integer is not rounded.
  return significant(option.minimum, 10) + "…" + significant(option.maximum, 10) +
         (option.odd ? ", odd" : "");
}

}  // namespace

std::optional<int> parse_integer(std::string_view text) { return parse<int>(text); }

std::optional<double> parse_number(std::string_view text) {
  const std::optional<double> value = parse<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::string allowed_text(const OptionInfo& option) {
  std::string text;
  switch (option.type) {
    case Type::kFlag:
      text = "true, false";
      break;
    case Type::kInteger:
    case Type::kNumber:
      text = number_range(option);
      break;
    case Type::kChoice:
      text = joined(option.names);
      break;
    default:
      text = option.format;
  }
  return option.unset_name.empty() ? text : std::string(option.unset_name) + ", " + text;
}

std::string range_text(const OptionInfo& option) {
  switch (option.type) {
    case Type::kFlag:
      return "true | false";
    case Type::kChoice:
      return joined(option.names, " | ");
    case Type::kInteger:
      if (!option.only.empty()) return integer_list(option, " | ");
      [[fallthrough]];
    case Type::kNumber:
      return "[" + std::string(option.unit) + (option.unit.empty() ? "" : ", ") + allowed_text(option) + "]";
    default:
      return "[" + std::string(option.format) + "]";
  }
}

std::string value_text(const OptionInfo& option, const OptionValue& value) {
  struct Visitor {
    std::string_view unset_name;
    std::string operator()(std::monostate) const { return std::string(unset_name); }
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(int number) const { return std::to_string(number); }
    std::string operator()(double number) const { return significant(number, 10); }
    std::string operator()(const std::string& text) const { return text; }
    std::string operator()(const NamedIntegers& numbers) const {
      std::string list;
      for (const auto& [name, number] : numbers) {
        list += (list.empty() ? "" : ", ") + name + ": " + std::to_string(number);
      }
      return "{" + list + "}";
    }
  };
  return std::visit(Visitor{option.unset_name}, value);
}

std::string_view first_sentence(const OptionInfo& option) {
  const std::size_t end = option.description.find(". ");
  std::string_view sentence = option.description.substr(0, end);
  if (sentence.ends_with('.')) sentence.remove_suffix(1);
  return sentence;
}

bool allows(const OptionInfo& option, const OptionValue& value) {
  if (const int* integer = std::get_if<int>(&value)) return allows_integer(option, *integer);
  if (const double* number = std::get_if<double>(&value)) return in_range(option, *number);
  return true;
}

std::optional<OptionValue> parse_value(const OptionInfo& option, std::string_view text) {
  if (!option.unset_name.empty() && text == option.unset_name) return OptionValue();
  switch (option.type) {
    case Type::kFlag:
      if (text == "true" || text == "false") return OptionValue(text == "true");
      break;
    case Type::kInteger:
      if (const auto number = parse_integer(text); number && allows_integer(option, *number)) {
        return OptionValue(*number);
      }
      break;
    case Type::kNumber:
      if (const auto number = parse_number(text); number && in_range(option, *number)) {
        return OptionValue(*number);
      }
      break;
    case Type::kChoice:
      if (std::find(option.names.begin(), option.names.end(), text) != option.names.end()) {
        return OptionValue(std::string(text));
      }
      break;
    default:
      if (option.accepts == nullptr || option.accepts(text)) return OptionValue(std::string(text));
  }
  return std::nullopt;
}

std::string complaint(const OptionInfo& option, std::string_view found) {
  std::string text = "found ";
  const bool is_number = parse_number(found).has_value();
  text += is_number ? std::string(found) : "'" + std::string(found) + "'";
  text += ", allowed " + allowed_text(option);
  if (option.type == Type::kInteger && option.only.empty() && !parse_integer(found))
    text += " (whole numbers)";
  return text;
}

}  // namespace stereod
