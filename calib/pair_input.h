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

/// Whether two pictures are of one size and alike in every pixel.
bool same_pixels(const GreyImage& a, const GreyImage& b);

/// Which files: one of the three is given.
struct PairInput {
  std::vector<std::filesystem::path> left, right;   ///< paired in this order
  std::vector<std::filesystem::path> side_by_side;  ///< each both pictures, left half and right half
  std::filesystem::path folder;                     ///< see find_pairs()
};

/// The files that read_pairs() would read. Throws as it does for what is given.
std::vector<std::filesystem::path> files_of(const PairInput& input);

/// Reads the pictures, all of one size. Throws UsageError (none or several ways given, unequal numbers of
/// files) and FileError (unreadable, different sizes, left and right the same picture in all pairs).
std::vector<PicturePair> read_pairs(const PairInput& input);

}  // namespace stereod
