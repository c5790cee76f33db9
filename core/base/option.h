// SPDX-License-Identifier: BSD-3-Clause
// Describes settings. One table row for each drives reading, --help, validation and the manual.
#pragma once

#include <concepts>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/enum_names.h"

namespace stereod {

/// Whole numbers by name.
using NamedIntegers = std::map<std::string, int>;

/// The value of a setting; the first kind means "not set". Names of enumerations and of files are text.
using OptionValue = std::variant<std::monostate, bool, int, double, std::string, NamedIntegers>;

/// Describes a setting without its value.
struct OptionInfo {
  enum class Type { kFlag, kInteger, kNumber, kChoice, kText, kFile, kIntegers };

  std::string_view key;
  Type type = Type::kText;
  std::string_view unit = {};
  double minimum = 0, maximum = 0;              ///< of kInteger and kNumber
  bool odd = false;                             ///< kInteger: only odd numbers
  std::vector<int> only = {};                   ///< kInteger: only these
  std::vector<std::string_view> names = {};     ///< of kChoice
  std::string_view format = {};                 ///< of kText and kFile: what is allowed
  bool (*accepts)(std::string_view) = nullptr;  ///< kText: whether it has this format
  std::string_view unset_name = {};             ///< the text that means "not set"; empty: leaving out the key
  bool required = false;
  std::string_view default_name = {};  ///< what the default stands for, such as "half a frame period"
  std::string_view only_with = {};     ///< the setting that it needs, such as "method: block"
  std::string_view example = {};       ///< what a file shows where there is no default
  std::string_view description = {};   ///< sentences; the first one stands alone in --help
};

/// Describes a setting of @p Settings and where its value is.
template <typename Settings>
struct Option : OptionInfo {
  OptionValue (*get)(const Settings&) = nullptr;
  void (*set)(Settings&, const OptionValue&) = nullptr;
};

/// Returns the allowed values in one line: "1…256", "3…31, odd", "auto, lock, follow".
std::string allowed_text(const OptionInfo& option);

/// Returns the first line about a setting in files and manuals: "[px, 1…256]", "auto | lock | follow".
std::string range_text(const OptionInfo& option);

/// Returns the value as it is written in a configuration file, without quotes.
std::string value_text(const OptionInfo& option, const OptionValue& value);

/// Returns the first sentence of the description, without its full stop.
std::string_view first_sentence(const OptionInfo& option);

/// Returns the value that the text names, nothing if the option does not allow it. Not for kFile and kIntegers.
std::optional<OptionValue> parse_value(const OptionInfo& option, std::string_view text);

/// Returns whether the option allows the value.
bool allows(const OptionInfo& option, const OptionValue& value);

/// Returns "found 300, allowed 1…256".
std::string complaint(const OptionInfo& option, std::string_view found);

/// Returns the number that the whole text is, nothing if it is not one.
std::optional<int> parse_integer(std::string_view text);
std::optional<double> parse_number(std::string_view text);

namespace option_detail {

/// A member that names a file, such as std::filesystem::path, which core/ does not know.
template <typename Member>
concept FileName = requires(const Member& member, const std::string& text) {
  { member.string() } -> std::convertible_to<std::string>;
  Member(text);
};

template <typename Struct, typename Member>
Struct struct_of(Member Struct::*);

/// Follows members: member_of<&A::b, &B::c>(a) is a.b.c.
template <auto First, auto... Rest, typename Struct>
constexpr auto& member_of(Struct& from) {
  if constexpr (sizeof...(Rest) == 0) {
    return from.*First;
  } else {
    return member_of<Rest...>(from.*First);
  }
}

template <typename Member>
OptionValue value_of(const Member& member) {
  if constexpr (FileName<Member>) {
    return member.string();
  } else {
    return member;
  }
}
template <typename Member>
OptionValue value_of(const std::optional<Member>& member) {
  return member ? OptionValue(*member) : OptionValue();
}

template <typename Member>
void assign(Member& member, const OptionValue& value) {
  if constexpr (FileName<Member>) {
    member = std::get<std::string>(value);
  } else {
    member = std::get<Member>(value);
  }
}
template <typename Member>
void assign(std::optional<Member>& member, const OptionValue& value) {
  if (std::holds_alternative<std::monostate>(value)) {
    member.reset();
  } else {
    member = std::get<Member>(value);
  }
}

template <typename Member>
constexpr OptionInfo::Type type_of(OptionInfo::Type type) {
  using M = std::remove_cvref_t<Member>;
  if constexpr (std::is_same_v<M, bool>) return OptionInfo::Type::kFlag;
  if constexpr (std::is_same_v<M, int> || std::is_same_v<M, std::optional<int>>)
    return OptionInfo::Type::kInteger;
  if constexpr (std::is_same_v<M, double> || std::is_same_v<M, std::optional<double>>)
    return OptionInfo::Type::kNumber;
  if constexpr (option_detail::FileName<M>) return OptionInfo::Type::kFile;
  if constexpr (std::is_same_v<M, NamedIntegers>) return OptionInfo::Type::kIntegers;
  return type;
}

}  // namespace option_detail

/// Makes the row for a bool, int, double, text, file name or NamedIntegers, reached by following the members.
template <auto First, auto... Rest>
auto option(OptionInfo info) {
  using Settings = decltype(option_detail::struct_of(First));
  using Member = decltype(option_detail::member_of<First, Rest...>(std::declval<Settings&>()));
  info.type = option_detail::type_of<Member>(info.type);
  return Option<Settings>{std::move(info),
                          [](const Settings& from) {
                            return option_detail::value_of(option_detail::member_of<First, Rest...>(from));
                          },
                          [](Settings& to, const OptionValue& value) {
                            option_detail::assign(option_detail::member_of<First, Rest...>(to), value);
                          }};
}

/// Makes the row for an enumeration whose names are @p Names, an EnumNames.
template <const auto& Names, auto First, auto... Rest>
auto choice(OptionInfo info) {
  using Settings = decltype(option_detail::struct_of(First));
  info.type = OptionInfo::Type::kChoice;
  for (const auto& [value, name] : Names) info.names.push_back(name);
  return Option<Settings>{
      std::move(info),
      [](const Settings& from) {
        return OptionValue(std::string(find_name(Names, option_detail::member_of<First, Rest...>(from))));
      },
      [](Settings& to, const OptionValue& value) {
        option_detail::member_of<First, Rest...>(to) =
            find_value(Names, std::get<std::string>(value)).value();
      }};
}

}  // namespace stereod
