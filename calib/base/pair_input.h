// SPDX-License-Identifier: BSD-3-Clause
// Reads the image pairs that a command line names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/image.h"

namespace stereod::calib {

/// A left and a right image taken at the same time.
struct ImagePair {
  std::string name;  ///< for messages: "left_03.png, right_03.png"
  GrayImage left, right;
};

/// Returns whether @p a and @p b have the same size and pixels.
bool same_pixels(const GrayImage& a, const GrayImage& b);

/// Files with image pairs. Exactly one of the three ways is used.
struct PairInput {
  std::vector<std::filesystem::path> left, right;   ///< paired by position
  std::vector<std::filesystem::path> side_by_side;  ///< one file per pair: left half, right half
  std::filesystem::path directory;                  ///< searched by find_pairs()
};

/// Returns the files that read_pairs() would read.
/// @throws UsageError, FileError as read_pairs() does, but reads no image.
std::vector<std::filesystem::path> files_of(const PairInput& input);

/// Reads all pairs; all images have the same size.
/// @throws UsageError if none or several of the three ways are used, or the numbers of left and right files differ.
/// @throws FileError if a file cannot be read, sizes differ, or left and right are the same image in every pair.
std::vector<ImagePair> read_pairs(const PairInput& input);

}  // namespace stereod::calib
