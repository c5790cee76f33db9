// SPDX-License-Identifier: BSD-3-Clause
// Stereo pairs from image files, in memory.
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/image.h"

namespace stereod {

struct RecordedPair {
  GrayImage left;
  GrayImage right;
};

struct PairFiles {
  std::filesystem::path left;
  std::filesystem::path right;
};

/// Returns the image files of a directory's pairs, in the order of their numbers. The directory contains
/// either
///   - the directories `left` and `right` (or `l` and `r`), whose image files end with a number, or
///   - files like left_00.png and right_00.png: `left` or `l`, an optional `_` or `-`, and the number. A pair
///     without a number must be the only one.
/// Names are not case-sensitive. Images are .png, .jpg, .jpeg, .pgm and .ppm; other files are ignored.
/// @throws FileError if there is no pair, an image without a partner, or two images with one number.
std::vector<PairFiles> find_pairs(const std::filesystem::path& directory);

/// One or more stereo pairs: all images have one size and fit into 1 GiB together. Immutable.
class Recording {
 public:
  /// Reads one pair. @throws FileError if a file cannot be read (see read_gray()) or the sizes differ.
  Recording(const std::filesystem::path& left, const std::filesystem::path& right);

  /// Reads all pairs that find_pairs() finds. @throws FileError as find_pairs() does, and if a file cannot be
  /// read, the sizes differ, or the images need more than 1 GiB.
  explicit Recording(const std::filesystem::path& directory);

  Size frame_size() const { return pairs_.front().left.size(); }
  const std::vector<RecordedPair>& pairs() const { return pairs_; }

 private:
  std::vector<RecordedPair> pairs_;
};

}  // namespace stereod
