// SPDX-License-Identifier: BSD-3-Clause
// Tests the description of options.
#include "core/base/option.h"

#include <gtest/gtest.h>

namespace stereod {
namespace {

TEST(OptionInfo, Texts_AreThoseOfRangeAndValue) {
  const OptionInfo number{
      .key = "x", .type = OptionInfo::Type::kNumber, .unit = "ms", .minimum = 0.1, .maximum = 1e6};
  EXPECT_EQ(range_text(number), "[ms, 0.1…1000000]");
  EXPECT_EQ(complaint(number, "-1"), "found -1, allowed 0.1…1000000");
  EXPECT_EQ(complaint(number, "nan"), "found 'nan', allowed 0.1…1000000");
  EXPECT_EQ(parse_value(number, "0.1"), OptionValue(0.1));
  EXPECT_EQ(parse_value(number, "0.09"), std::nullopt);
  EXPECT_EQ(parse_value(number, "nan"), std::nullopt);
  EXPECT_EQ(parse_value(number, "1 "), std::nullopt);
  const OptionInfo rows{
      .key = "rows", .type = OptionInfo::Type::kInteger, .minimum = 1, .maximum = 9, .unset_name = "auto"};
  EXPECT_EQ(range_text(rows), "[auto, 1…9]");
  EXPECT_EQ(complaint(rows, "6.5"), "found 6.5, allowed auto, 1…9 (whole numbers)");
  EXPECT_EQ(parse_value(rows, "auto"), OptionValue());
  EXPECT_EQ(value_text(rows, OptionValue()), "auto");
  const OptionInfo flag{.key = "f", .type = OptionInfo::Type::kFlag};
  EXPECT_EQ(range_text(flag), "true | false");
  EXPECT_EQ(complaint(flag, "maybe"), "found 'maybe', allowed true, false");
  EXPECT_EQ(parse_value(flag, "yes"), std::nullopt);
  const OptionInfo choices{.key = "c", .type = OptionInfo::Type::kChoice, .names = {"none", "start"}};
  EXPECT_EQ(range_text(choices), "none | start");
  EXPECT_EQ(complaint(choices, "off"), "found 'off', allowed none, start");
}

}  // namespace
}  // namespace stereod
