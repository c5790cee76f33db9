// A moment of stereo-view, as its page takes it apart.
#pragma once

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>
#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace stereod {

struct DecodedMoment {
  YAML::Node json;  // JSON is YAML
  std::vector<std::int16_t> disparity;
  std::string left;
};

inline DecodedMoment decoded_moment(const std::string& bytes) {
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data(), 4);
  DecodedMoment result{YAML::Load(bytes.substr(4, length)), {}, {}};
  const std::string compressed = bytes.substr(4 + length, result.json["disparity_bytes"].as<std::size_t>());
  result.left = bytes.substr(4 + length + compressed.size());
  std::vector<std::int16_t> room(1'000'000);
  uLongf size = room.size() * 2;
  if (compressed.empty()) return result;
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(room.data()), &size,
                       reinterpret_cast<const Bytef*>(compressed.data()), compressed.size()),
            Z_OK);
  room.resize(size / 2);
  result.disparity = room;
  return result;
}

}  // namespace stereod
