#include "calib/pair_input.h"

#include <algorithm>

#include "calib/errors.h"
#include "calib/progress.h"
#include "daemon/capture/recording.h"
#include "daemon/config/file_error.h"
#include "daemon/imagefile/read_image.h"

namespace stereod {

namespace {

namespace fs = std::filesystem;

std::string in_words(Size size) { return std::to_string(size.width) + "×" + std::to_string(size.height); }

GreyImage part_of(const GreyImage& picture, int first_column, int width) {
  GreyImage result(width, picture.height());
  for (int y = 0; y < picture.height(); ++y) {
    std::copy_n(picture.row(y) + first_column, width, result.row(y));
  }
  return result;
}

PicturePair split(const fs::path& file) {
  const GreyImage both = read_grey(file);
  if (both.width() < 2 || both.width() % 2 != 0) {
    throw FileError(file.string() + ": is " + std::to_string(both.width()) +
                    " pixels wide, which cannot be cut into two equal halves");
  }
  const int half = both.width() / 2;
  return {file.filename().string(), part_of(both, 0, half), part_of(both, half, half)};
}

std::vector<PairFiles> pair_files(const PairInput& input) {
  if (!input.folder.empty()) return find_pairs(input.folder);
  if (input.left.size() != input.right.size()) {
    throw UsageError("there are " + std::to_string(input.left.size()) + " left pictures and " +
                     std::to_string(input.right.size()) +
                     " right ones; each needs its partner, in the same order");
  }
  std::vector<PairFiles> files;
  for (std::size_t i = 0; i < input.left.size(); ++i) files.push_back({input.left[i], input.right[i]});
  return files;
}

void check_usage(const PairInput& input) {
  const bool lists = !input.left.empty() || !input.right.empty();
  const int ways = (lists ? 1 : 0) + (input.side_by_side.empty() ? 0 : 1) + (input.folder.empty() ? 0 : 1);
  if (ways == 1) return;
  throw UsageError(std::string(ways == 0 ? "there are no pictures" : "pictures are given in two ways") +
                   "; name a folder of pairs, or --left and --right files, or --side-by-side files");
}

void require_size(const std::string& file, Size found, const PicturePair& first) {
  if (found == first.left.size()) return;
  throw FileError(file + ": has " + in_words(found) + " pixels, but the first left picture has " +
                  in_words(first.left.size()) +
                  "; all pictures must have the size that the cameras will run at");
}

}  // namespace

bool same_pixels(const GreyImage& a, const GreyImage& b) {
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

std::vector<PicturePair> read_pairs(const PairInput& input) {
  check_usage(input);
  std::vector<PicturePair> pairs;
  if (!input.side_by_side.empty()) {
    Progress progress("reading pictures", input.side_by_side.size());
    for (const fs::path& file : input.side_by_side) {
      pairs.push_back(split(file));
      require_size(file.string(), pairs.back().left.size(), pairs.front());
      progress.step();
    }
  } else {
    const std::vector<PairFiles> files = pair_files(input);
    Progress progress("reading pictures", files.size());
    for (const PairFiles& file : files) {
      pairs.push_back({file.left.filename().string() + ", " + file.right.filename().string(),
                       read_grey(file.left), read_grey(file.right)});
      require_size(file.left.string(), pairs.back().left.size(), pairs.front());
      require_size(file.right.string(), pairs.back().right.size(), pairs.front());
      progress.step();
    }
  }
  if (std::all_of(pairs.begin(), pairs.end(),
                  [](const PicturePair& p) { return same_pixels(p.left, p.right); })) {
    throw FileError(pairs.front().name +
                    ": left and right are the same picture; give the left camera's pictures as left and the "
                    "right camera's as right");
  }
  return pairs;
}

}  // namespace stereod
