// SPDX-License-Identifier: BSD-3-Clause
// Tests the conversion of values to text.
#include "daemon/base/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace stereod {
namespace {

TEST(Text, Numbers_HaveTheDigitsAskedFor) {
  EXPECT_EQ(fixed(1.25, 1), "1.2");
  EXPECT_EQ(fixed(-0.5, 0), "-0");
  EXPECT_EQ(fixed(std::numeric_limits<double>::infinity(), 2), "-");
  EXPECT_EQ(fixed(std::nan(""), 2), "-");
  EXPECT_EQ(fixed(std::numeric_limits<double>::max(), 0).size(), 309U);
  EXPECT_EQ(significant(30), "30");
  EXPECT_EQ(significant(7.5), "7.5");
  EXPECT_EQ(significant(29.97003, 4), "29.97");
  EXPECT_EQ(exact(0.1), "0.1");
  EXPECT_EQ(exact(1.0 / 3), "0.3333333333333333");
  EXPECT_EQ(std::stod(exact(std::sqrt(2.0))), std::sqrt(2.0));
}

TEST(Text, Size_IsWidthByHeight) { EXPECT_EQ(to_string(Size{640, 480}), "640×480"); }

TEST(Text, List_HasItsSeparators) {
  const std::vector<std::string_view> words{"a", "b", "c"};
  EXPECT_EQ(joined(words), "a, b, c");
  EXPECT_EQ(joined(words, ", ", " or "), "a, b or c");
  EXPECT_EQ(joined(std::vector<std::string_view>{"a"}, ", ", " or "), "a");
  EXPECT_EQ(joined(std::vector<std::string_view>{}), "");
}

}  // namespace
}  // namespace stereod
