// SPDX-License-Identifier: BSD-3-Clause
// Finding and reading the files of a recording.
#include "daemon/capture/replay/recording.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/text.h"
#include "daemon/base/file_error.h"
#include "daemon/imagefile/read_image.h"

namespace stereod {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMemoryLimit = std::size_t{1} << 30;

/// The number in a file name, of any length: the count of its digits without leading zeros, and the digits.
/// Comparing them orders by value.
using FrameNumber = std::pair<std::size_t, std::string>;

using NumberedFiles = std::map<FrameNumber, fs::path>;

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_image(const fs::path& path) {
  const std::string extension = lower_case(path.extension().string());
  return extension == ".png" || extension == ".jpg" || extension == ".jpeg" || extension == ".pgm" ||
         extension == ".ppm";
}

/// Splits "left_007" into "left_" and 7.
std::pair<std::string, FrameNumber> split_number(const std::string& stem) {
  std::size_t first_digit = stem.size();
  while (first_digit > 0 && is_digit(stem[first_digit - 1])) --first_digit;
  const std::size_t significant = std::min(stem.find_first_not_of('0', first_digit), stem.size());
  return {stem.substr(0, first_digit), {stem.size() - significant, stem.substr(significant)}};
}

void add_file(NumberedFiles& files, const FrameNumber& number, const fs::path& path) {
  const auto [place, added] = files.emplace(number, path);
  if (!added) {
    throw FileError(path.string() + ": same number as " + place->second.filename().string() +
                    "; each pair needs its own number");
  }
}

/// Returns the directory's entries, sorted so that messages do not depend on the file system.
std::vector<fs::path> entries_of(const fs::path& directory) {
  std::error_code error;
  if (!fs::exists(directory, error)) {
    throw FileError(directory.string() + ": no such directory");
  }
  if (!fs::is_directory(directory, error)) {
    throw FileError(directory.string() + ": not a directory; a directory of numbered pairs is needed");
  }
  std::vector<fs::path> entries;
  fs::directory_iterator next(directory, error);
  for (; !error && next != fs::directory_iterator(); next.increment(error)) entries.push_back(next->path());
  if (error) throw FileError(directory.string() + ": the directory cannot be read (" + error.message() + ")");
  std::sort(entries.begin(), entries.end());
  return entries;
}

/// Returns the numbered images of a directory that contains one side.
NumberedFiles numbered_files(const fs::path& directory) {
  NumberedFiles files;
  for (const fs::path& path : entries_of(directory)) {
    const std::string stem = path.stem().string();
    if (!is_image(path) || stem.empty() || !is_digit(stem.back())) continue;
    add_file(files, split_number(stem).second, path);
  }
  return files;
}

bool begins_with_side(std::string prefix, char side) {
  if (!prefix.empty() && (prefix.back() == '_' || prefix.back() == '-')) prefix.pop_back();
  return prefix == (side == 'l' ? "left" : "right") || prefix == std::string(1, side);
}

/// Joins left and right files with the same number.
std::vector<PairFiles> join(const NumberedFiles& left, const NumberedFiles& right) {
  const auto require_partner = [](const fs::path& path, const FrameNumber& number,
                                  const NumberedFiles& others, const char* side) {
    if (others.contains(number)) return;
    throw FileError(path.string() + ": no " + side + " image with the same number");
  };
  std::vector<PairFiles> pairs;
  for (const auto& [number, path] : left) {
    require_partner(path, number, right, "right");
    pairs.push_back({path, right.at(number)});
  }
  for (const auto& [number, path] : right) require_partner(path, number, left, "left");
  return pairs;
}

}  // namespace

std::vector<PairFiles> find_pairs(const fs::path& directory) {
  const std::vector<fs::path> entries = entries_of(directory);
  const auto directory_of = [&](char side) -> std::optional<fs::path> {
    for (const fs::path& path : entries) {
      std::error_code error;
      if (begins_with_side(lower_case(path.filename().string()), side) && fs::is_directory(path, error))
        return path;
    }
    return std::nullopt;
  };

  std::vector<PairFiles> pairs;
  const std::optional<fs::path> left_directory = directory_of('l');
  const std::optional<fs::path> right_directory = directory_of('r');
  if (left_directory && right_directory) {
    pairs = join(numbered_files(*left_directory), numbered_files(*right_directory));
  } else {
    NumberedFiles left;
    NumberedFiles right;
    for (const fs::path& path : entries) {
      if (!is_image(path)) continue;
      const auto [prefix, number] = split_number(lower_case(path.stem().string()));
      if (begins_with_side(prefix, 'l')) add_file(left, number, path);
      if (begins_with_side(prefix, 'r')) add_file(right, number, path);
    }
    pairs = join(left, right);
  }
  if (pairs.empty()) {
    throw FileError(directory.string() +
                    ": no stereo pair found; files like left_00.png and right_00.png, or directories left "
                    "and right with numbered images, are needed");
  }
  return pairs;
}

namespace {

void require_size(const fs::path& path, Size found, Size wanted, const fs::path& first) {
  if (found == wanted) return;
  throw FileError(path.string() + ": has " + to_string(found) + " pixels, but " + first.filename().string() +
                  " has " + to_string(wanted) + "; all images of a recording must have one size");
}

std::vector<RecordedPair> load(const std::vector<PairFiles>& files, const fs::path& name) {
  std::vector<RecordedPair> pairs;
  for (const PairFiles& file : files) {
    RecordedPair pair{read_gray(file.left), read_gray(file.right)};
    const Size size = pairs.empty() ? pair.left.size() : pairs.front().left.size();
    require_size(file.left, pair.left.size(), size, files.front().left);
    require_size(file.right, pair.right.size(), size, files.front().left);
    const std::size_t bytes =
        2 * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    if (files.size() > kMemoryLimit / bytes) {
      throw FileError(name.string() + ": " + std::to_string(files.size()) + " pairs of " + to_string(size) +
                      " pixels exceed the limit of 1 GiB; remove some");
    }
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

}  // namespace

Recording::Recording(const fs::path& left, const fs::path& right) : pairs_(load({{left, right}}, left)) {}

Recording::Recording(const fs::path& directory) : pairs_(load(find_pairs(directory), directory)) {}

}  // namespace stereod
