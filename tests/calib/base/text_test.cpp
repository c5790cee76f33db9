// SPDX-License-Identifier: BSD-3-Clause
// Text and statistics helpers.
#include "calib/base/text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "calib/base/statistics.h"
#include "daemon/base/progress.h"

namespace stereod::calib {
namespace {

using testing::ElementsAre;

TEST(Statistics, MedianAndSpacing_Known) {
  EXPECT_THAT(evenly_spaced(3, 13), ElementsAre(2U, 6U, 10U));
  EXPECT_THAT(evenly_spaced(1, 5), ElementsAre(2U));
  EXPECT_EQ(median({3, 1, 2}), 2);
}

TEST(Text, Formatting_SafeAndReadable) {
  EXPECT_EQ(escape_html("<a href=\"x\">&"), "&lt;a href=&quot;x&quot;&gt;&amp;");
  EXPECT_EQ(format_length(0.0034), "3.4 mm");
  EXPECT_EQ(format_length(0.042), "4.2 cm");
  EXPECT_EQ(format_length(0.42), "42 cm");
  EXPECT_EQ(format_length(1.34), "1.3 m");
  EXPECT_EQ(format_length(std::numeric_limits<double>::infinity()), "unknown");
  const auto encoded = [](const std::string& text) {
    return base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");  // RFC 4648
  EXPECT_EQ(encoded("fooba"), "Zm9vYmE=");
  EXPECT_EQ(encoded("foob"), "Zm9vYg==");
  EXPECT_EQ(progress_bar(1, 4, 8), "[##......]");
  EXPECT_EQ(progress_bar(0, 0, 3), "[###]");
}

}  // namespace
}  // namespace stereod::calib
