// SPDX-License-Identifier: BSD-3-Clause
// Decodes a snapshot of stereo-view as its page does.
#pragma once

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>
#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace stereod {

struct DecodedSnapshot {
  YAML::Node json;  // JSON is YAML
  std::vector<std::int16_t> disparity;
  std::string left;
};

inline DecodedSnapshot decode_snapshot(const std::string& bytes) {
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data(), 4);
  DecodedSnapshot result{YAML::Load(bytes.substr(4, length)), {}, {}};
  const std::string compressed = bytes.substr(4 + length, result.json["disparity_bytes"].as<std::size_t>());
  result.left = bytes.substr(4 + length + compressed.size());
  if (compressed.empty()) return result;
  std::vector<std::uint8_t> planes(2'000'000);  // low bytes, then high bytes
  uLongf size = planes.size();
  EXPECT_EQ(
      uncompress(planes.data(), &size, reinterpret_cast<const Bytef*>(compressed.data()), compressed.size()),
      Z_OK);
  const YAML::Node frame = result.json["frame"];
  const auto width = static_cast<std::size_t>((frame["width"].as<int>() + frame["step"].as<int>() - 1) /
                                              frame["step"].as<int>());
  for (std::size_t i = 0; i < size / 2; ++i) {
    const int folded = planes[i] | planes[size / 2 + i] << 8;
    const int difference = folded % 2 == 0 ? folded / 2 : -(folded + 1) / 2;
    const int above = i < width ? 0 : result.disparity[i - width];
    result.disparity.push_back(static_cast<std::int16_t>(above + difference));
  }
  return result;
}

}  // namespace stereod
