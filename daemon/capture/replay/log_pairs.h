// SPDX-License-Identifier: BSD-3-Clause
// The raw image pairs of an LCM log, in memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/image.h"

namespace stereod {

struct LoggedImage {
  std::int64_t utime = 0;  ///< exposure [µs since the Unix epoch]
  GrayImage image;
};
struct LoggedPair {
  LoggedImage left, right;
};

struct LoggedPairs {
  std::vector<LoggedPair> pairs;  ///< one or more, in the order of time, all images of one size
  int unpaired = 0;               ///< images without a partner, and messages that are no 8-bit gray image
};

/// Reads the images on PREFIX_LEFT_RAW and PREFIX_RIGHT_RAW. Two images are a pair if each is the other one's
/// nearest in time, within 0.5 s. Nothing in the file is trusted: a message is decoded only if its layout is
/// that of an image_t without metadata, and every length lies inside the message.
/// @throws FileError with one sentence: no LCM log, no pair, different sizes, more than 4 GiB of images (1
/// GiB on 32-bit machines).
LoggedPairs read_logged_pairs(const std::filesystem::path& file, const std::string& prefix);

}  // namespace stereod
