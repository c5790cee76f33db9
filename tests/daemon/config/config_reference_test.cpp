// SPDX-License-Identifier: BSD-3-Clause
// Holds etc/stereod.yaml and stereod.yaml(5) against the tables of options.
#include "tests/daemon/config/config_file.h"

#include <algorithm>
#include <fstream>
#include <regex>
#include <string>

#include "core/match/option_table.h"
#include "daemon/base/file.h"
#include "daemon/config/reference.h"

namespace stereod {
namespace {

// The values in the comments of etc/stereod.yaml are the defaults: uncommented, they change nothing.
TEST_F(ConfigFile, ShippedFile_GivesDefaults) {
  std::ifstream in(std::string(STEREOD_SOURCE_DIR) + "/etc/stereod.yaml");
  std::string uncommented;
  std::string block_keys;
  int matcher_keys = 0;
  const auto is_of_block = [](const std::string& key) {
    const auto& table = matcher_option_table();
    return std::any_of(table.begin(), table.end(), [&](const MatcherOption& option) {
      return option.key == key && !belongs_to(option, Method::kSemiglobal);
    });
  };
  for (std::string line; std::getline(in, line);) {
    static const std::regex kCommentedKey("  # (([a-z_0-9]+): [a-z0-9-]+)");
    std::smatch match;
    if (std::regex_match(line, match, kCommentedKey)) {
      const std::string entry = "  " + match[1].str();
      if (is_of_block(match[2].str())) {
        block_keys += entry + "\n";
      } else {
        line = entry;
        ++matcher_keys;
      }
    }
    uncommented += line + "\n";
  }
  EXPECT_EQ(matcher_keys, 17);
  EXPECT_EQ(std::count(block_keys.begin(), block_keys.end(), '\n'), 4);
  EXPECT_EQ(read("cameras: {source: synthetic}\nmatcher:\n  preset: fast\n" + block_keys).matcher,
            matcher_preset("fast"));
  const Config defaults;
  const Config shipped = read(uncommented);
  EXPECT_EQ(shipped.cameras.fps, defaults.cameras.fps);
  EXPECT_EQ(shipped.cameras.width, defaults.cameras.width);
  EXPECT_EQ(shipped.cameras.height, defaults.cameras.height);
  EXPECT_EQ(shipped.cameras.source, SourceKind::kV4l2);
  EXPECT_EQ(shipped.cameras.v4l2.left, defaults.cameras.v4l2.left);
  EXPECT_EQ(shipped.cameras.v4l2.right, defaults.cameras.v4l2.right);
  EXPECT_EQ(shipped.cameras.v4l2.width, defaults.cameras.v4l2.width);
  EXPECT_EQ(shipped.cameras.v4l2.height, defaults.cameras.v4l2.height);
  EXPECT_EQ(shipped.cameras.v4l2.format, defaults.cameras.v4l2.format);
  EXPECT_EQ(shipped.cameras.v4l2.exposure, defaults.cameras.v4l2.exposure);
  EXPECT_TRUE(shipped.cameras.v4l2.controls.empty());
  EXPECT_EQ(shipped.cameras.v4l2.sync, defaults.cameras.v4l2.sync);
  EXPECT_EQ(shipped.cameras.v4l2.max_sync_skew_ms, defaults.cameras.v4l2.max_sync_skew_ms);
  EXPECT_EQ(shipped.cameras.v4l2.sync_attempts, defaults.cameras.v4l2.sync_attempts);
  EXPECT_EQ(shipped.lcm.raw_images, defaults.lcm.raw_images);
  EXPECT_EQ(shipped.lcm.raw_images_per_second, defaults.lcm.raw_images_per_second);
  EXPECT_EQ(shipped.rectify.interpolation, defaults.rectify.interpolation);
  EXPECT_EQ(shipped.rectify.alpha, defaults.rectify.alpha);
  EXPECT_EQ(shipped.matcher, defaults.matcher);
  EXPECT_EQ(shipped.lcm.url, defaults.lcm.url);
  EXPECT_EQ(shipped.lcm.prefix, defaults.lcm.prefix);
  EXPECT_EQ(shipped.lcm.rows_per_message, defaults.lcm.rows_per_message);
  EXPECT_EQ(shipped.lcm.pacing, defaults.lcm.pacing);
  EXPECT_EQ(shipped.workers, defaults.workers);
  EXPECT_EQ(shipped.scheduling.priority, defaults.scheduling.priority);
  EXPECT_TRUE(shipped.scheduling.cpus.empty());
  EXPECT_EQ(shipped.log_level, defaults.log_level);
}

// The tables of options are the source of the file and of the manual page. After a change of a table:
// cmake --build --preset release --target write_reference && build/release/bin/write_reference .
TEST(ConfigReference, ShippedFileAndManualPage_EqualTheTables) {
  const std::string root = STEREOD_SOURCE_DIR;
  EXPECT_EQ(read_text_file(root + "/etc/stereod.yaml", 1'000'000), reference_yaml());
  EXPECT_EQ(read_text_file(root + "/docs/man/stereod.yaml.5", 1'000'000), reference_man_page());
}

// Every line that a key has in the file: its range, its default, its description, its value.
TEST(ConfigReference, ShippedFile_HasEveryKeyWithRangeAndDefault) {
  const std::string yaml = read_text_file(std::string(STEREOD_SOURCE_DIR) + "/etc/stereod.yaml", 1'000'000);
  const std::string unwrapped = std::regex_replace(yaml, std::regex("\n *#[ #]*"), " ");
  std::size_t keys = 0;
  for (const SectionReference& section : config_reference()) {
    for (const OptionReference& option : section.options) {
      ++keys;
      const std::string key(option.info.key);
      EXPECT_TRUE(std::regex_search(yaml, std::regex("(^|\n)[ #]*" + key + ": "))) << key;
      EXPECT_NE(unwrapped.find(" " + range_text(option.info)), std::string::npos) << key;
      EXPECT_TRUE(option.info.description.ends_with('.')) << key;
      EXPECT_TRUE(allows(option.info, option.default_value)) << key;
    }
  }
  EXPECT_EQ(keys, 85U);
}

TEST_F(ConfigFile, DemoFile_Read) {
  EXPECT_NO_THROW(read_config(std::string(STEREOD_SOURCE_DIR) + "/etc/demo.yaml"));
}

}  // namespace
}  // namespace stereod
