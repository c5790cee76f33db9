// Stereo pairs from files, in memory.
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

/// The image files of a directory's pairs, in the order of their numbers. Either it has the directories `left`
/// and `right` (or `l` and `r`), in which a image's number is the digits that its name ends with, or it has
/// files like left_00.png and right_00.png: `left` or `l`, perhaps `_` or `-`, the number (without one: the
/// only pair). Capital letters are the same as small ones. Images are .png, .jpg, .jpeg, .pgm and .ppm;
/// other files do not matter. Throws FileError: no pair, a image without its partner, two with one number.
std::vector<PairFiles> find_pairs(const std::filesystem::path& directory);

/// At least one pair, all images of one size, at most 1 GiB in total.
class Recording {
 public:
  /// One pair. Throws FileError: a file cannot be read (read_gray()) or the two differ in size.
  Recording(const std::filesystem::path& left, const std::filesystem::path& right);

  /// All pairs that find_pairs() finds. Throws FileError: what that throws, different sizes, more than 1 GiB,
  /// a file that cannot be read.
  explicit Recording(const std::filesystem::path& directory);

  Size frame_size() const { return pairs_.front().left.size(); }
  const std::vector<RecordedPair>& pairs() const { return pairs_; }

 private:
  std::vector<RecordedPair> pairs_;
};

}  // namespace stereod
