// The pairs of images that a command is given.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/image.h"

namespace stereod {

/// Two images of one moment.
struct ImagePair {
  std::string name;  ///< for messages: "left_03.png, right_03.png"
  GrayImage left, right;
};

/// Whether two images are of one size and alike in every pixel.
bool same_pixels(const GrayImage& a, const GrayImage& b);

/// Which files: one of the three is given.
struct PairInput {
  std::vector<std::filesystem::path> left, right;   ///< paired in this order
  std::vector<std::filesystem::path> side_by_side;  ///< each both images, left half and right half
  std::filesystem::path directory;                  ///< see find_pairs()
};

/// The files that read_pairs() would read. Throws as it does for what is given.
std::vector<std::filesystem::path> files_of(const PairInput& input);

/// Reads the images, all of one size. Throws UsageError (none or several ways given, unequal numbers of
/// files) and FileError (unreadable, different sizes, left and right the same image in all pairs).
std::vector<ImagePair> read_pairs(const PairInput& input);

}  // namespace stereod
