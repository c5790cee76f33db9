// SPDX-License-Identifier: BSD-3-Clause
#include "calib/base/pair_input.h"

#include <algorithm>

#include "calib/base/errors.h"
#include "daemon/base/file_error.h"
#include "daemon/base/progress.h"
#include "daemon/capture/replay/recording.h"
#include "daemon/imagefile/read_image.h"

namespace stereod::calib {

namespace {

namespace fs = std::filesystem;

std::string to_string(Size size) { return std::to_string(size.width) + "×" + std::to_string(size.height); }

GrayImage columns_of(const GrayImage& image, int first_column, int width) {
  GrayImage result(width, image.height());
  for (int y = 0; y < image.height(); ++y) {
    std::copy_n(image.row(y) + first_column, width, result.row(y));
  }
  return result;
}

ImagePair split(const fs::path& file) {
  const GrayImage both = read_gray(file);
  if (both.width() < 2 || both.width() % 2 != 0) {
    throw FileError(file.string() + ": width is " + std::to_string(both.width()) +
                    " px; a side-by-side image needs an even width of at least 2 px");
  }
  const int half = both.width() / 2;
  return {file.filename().string(), columns_of(both, 0, half), columns_of(both, half, half)};
}

std::vector<PairFiles> pair_files(const PairInput& input) {
  if (!input.directory.empty()) return find_pairs(input.directory);
  if (input.left.size() != input.right.size()) {
    throw UsageError("found " + std::to_string(input.left.size()) + " left and " +
                     std::to_string(input.right.size()) +
                     " right images; give the same number of both, in the same order");
  }
  std::vector<PairFiles> files;
  for (std::size_t i = 0; i < input.left.size(); ++i) files.push_back({input.left[i], input.right[i]});
  return files;
}

void check_usage(const PairInput& input) {
  const bool lists = !input.left.empty() || !input.right.empty();
  const int ways = (lists ? 1 : 0) + (input.side_by_side.empty() ? 0 : 1) + (input.directory.empty() ? 0 : 1);
  if (ways == 1) return;
  throw UsageError(std::string(ways == 0 ? "no images given" : "images given in more than one way") +
                   "; give a directory of pairs, or --left and --right files, or --side-by-side files");
}

void require_size(const std::string& file, Size found, const ImagePair& first) {
  if (found == first.left.size()) return;
  throw FileError(file + ": size is " + to_string(found) + " px, but the first left image has " +
                  to_string(first.left.size()) +
                  " px; all images must have the size that the cameras run at");
}

}  // namespace

bool same_pixels(const GrayImage& a, const GrayImage& b) {
  if (a.size() != b.size()) return false;
  for (int y = 0; y < a.height(); ++y) {
    if (!std::equal(a.row(y), a.row(y) + a.width(), b.row(y))) return false;
  }
  return true;
}

std::vector<fs::path> files_of(const PairInput& input) {
  check_usage(input);
  if (!input.side_by_side.empty()) return input.side_by_side;
  std::vector<fs::path> files;
  for (const PairFiles& pair : pair_files(input)) {
    files.push_back(pair.left), files.push_back(pair.right);
  }
  return files;
}

std::vector<ImagePair> read_pairs(const PairInput& input) {
  check_usage(input);
  std::vector<ImagePair> pairs;
  if (!input.side_by_side.empty()) {
    Progress progress("reading images", input.side_by_side.size());
    for (const fs::path& file : input.side_by_side) {
      pairs.push_back(split(file));
      require_size(file.string(), pairs.back().left.size(), pairs.front());
      progress.step();
    }
  } else {
    const std::vector<PairFiles> files = pair_files(input);
    Progress progress("reading images", files.size());
    for (const PairFiles& file : files) {
      pairs.push_back({file.left.filename().string() + ", " + file.right.filename().string(),
                       read_gray(file.left), read_gray(file.right)});
      require_size(file.left.string(), pairs.back().left.size(), pairs.front());
      require_size(file.right.string(), pairs.back().right.size(), pairs.front());
      progress.step();
    }
  }
  if (std::all_of(pairs.begin(), pairs.end(),
                  [](const ImagePair& p) { return same_pixels(p.left, p.right); })) {
    throw FileError(pairs.front().name +
                    ": left and right are the same image in every pair; give the left camera's images as "
                    "left and the right camera's as right");
  }
  return pairs;
}

}  // namespace stereod::calib
