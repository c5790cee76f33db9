// The pairs of pictures that a command is given.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/image.h"

namespace stereod {

/// Two pictures of one moment.
struct PicturePair {
  std::string name;  ///< for messages: "left_03.png, right_03.png"
  GreyImage left, right;
};

/// Which files: one of the three is given.
struct PairInput {
  std::vector<std::filesystem::path> left, right;   ///< paired in this order
  std::vector<std::filesystem::path> side_by_side;  ///< each both pictures, left half and right half
  std::filesystem::path folder;                     ///< see find_pairs()
};

/// Reads the pictures, all of one size. Throws UsageError (none or several ways given, unequal numbers of
/// files) and FileError (unreadable, different sizes, left and right the same picture in all pairs).
std::vector<PicturePair> read_pairs(const PairInput& input);

}  // namespace stereod
