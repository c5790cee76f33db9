// SPDX-License-Identifier: BSD-3-Clause
// Loading of the stereo sets with ground truth.
#include "tests/bench/stereo_sets.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <regex>
#include <stdexcept>

#include "daemon/base/file_error.h"
#include "daemon/imagefile/read_image.h"
#include "daemon/tools/match/evaluation.h"
#include "tests/bench/bench_images.h"
#include "tests/bench/npz_file.h"

namespace stereod::bench {
namespace {

namespace fs = std::filesystem;

/// Returns the first number called @p key in a JSON file. A scanner, because OpenCV's reader refuses keys and
/// nulls of these files, and only three numbers are needed.
std::optional<double> number_in(const std::string& json, const std::string& key) {
  std::smatch match;
  const std::regex number("\"" + key + "\"\\s*:\\s*([0-9]+(\\.[0-9]+)?)");
  if (!std::regex_search(json, match, number)) return std::nullopt;
  return std::stod(match[1].str());
}

cv::Mat read_gray_mat(const fs::path& path) {
  // As stereo-match and the daemon read it. OpenCV's own reader converts colors to slightly different gray
  // levels.
  const GrayImage gray = read_gray(path);
  cv::Mat copy(gray.height(), gray.width(), CV_8UC1);
  for (int y = 0; y < gray.height(); ++y) std::copy_n(gray.row(y), gray.width(), copy.ptr(y));
  return copy;
}

StereoSet load_set(const std::string& name, const fs::path& left, const fs::path& right, Image<float> truth,
                   int disparities) {
  StereoSet set{name, read_gray_mat(left), read_gray_mat(right), std::move(truth), disparities};
  if (set.left.size() != set.right.size() || view_of(set.left).size() != set.truth.size()) {
    throw FileError(left.string() + ": the right image or the ground truth has another size");
  }
  return set;
}

/// Returns an empty optional if the directory is not a set with ground truth.
std::optional<StereoSet> load_middlebury(const fs::path& directory) {
  std::ifstream file(directory / "meta.json");
  const std::string json{std::istreambuf_iterator<char>(file), {}};
  const std::optional<double> scale = number_in(json, "gt_scale");
  const std::optional<double> disparities = number_in(json, "num_disparities_suggested");
  if (!scale || !disparities) return std::nullopt;
  return load_set(directory.filename().string(), directory / "left.png", directory / "right.png",
                  tools::read_ground_truth(directory / "gt.png", *scale), static_cast<int>(*disparities));
}

fs::path skimage_data() {
  if (const char* directory = std::getenv("STEREO_SKIMAGE_DATA")) return directory;
  return "/usr/lib/python3/dist-packages/skimage/data";
}

class Loader {
 public:
  explicit Loader(const std::vector<std::string>& names) : names_(names) {}

  void add_middlebury() {
    std::vector<fs::path> directories;
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(datasets(), none)) {
      if (wanted(entry.path().filename().string())) directories.push_back(entry.path());
    }
    std::sort(directories.begin(), directories.end());
    for (const fs::path& directory : directories) {
      if (std::optional<StereoSet> set = load_middlebury(directory)) found_.sets.push_back(std::move(*set));
    }
    if (none) {
      found_.missing.push_back("Middlebury: no directory " + datasets().string() +
                               "; set STEREO_DATASETS to where the sets are");
    }
  }

  void add_motorcycle() {
    const fs::path data = skimage_data();
    if (!wanted("motorcycle")) return;
    if (!fs::exists(data / "motorcycle_disp.npz")) {
      found_.missing.push_back("motorcycle: not in " + data.string() +
                               "; install python3-skimage, or unpack it (apt-get download, dpkg -x) and set "
                               "STEREO_SKIMAGE_DATA to its directory skimage/data");
      return;
    }
    found_.sets.push_back(load_set("motorcycle", data / "motorcycle_left.png", data / "motorcycle_right.png",
                                   read_npz_floats(data / "motorcycle_disp.npz"), 64));
  }

  void add_aloe() {
    const fs::path data = "/usr/share/doc/opencv-doc/examples/data";
    if (!wanted("aloe")) return;
    if (!fs::exists(data / "aloeGT.png")) {
      found_.missing.push_back("aloe: not in " + data.string() + "; install opencv-doc");
      return;
    }
    // Full resolution: the image's gray values are pixels.
    found_.sets.push_back(load_set("aloe", data / "aloeL.jpg", data / "aloeR.jpg",
                                   tools::read_ground_truth(data / "aloeGT.png", 1), 224));
  }

  StereoSets take() {
    for (const std::string& name : names_) {
      const bool known = std::any_of(found_.sets.begin(), found_.sets.end(),
                                     [&](const StereoSet& set) { return set.name == name; });
      if (known) continue;
      std::string sentence = "there is no set called " + name;
      for (const std::string& missing : found_.missing) sentence += "; " + missing;
      throw std::runtime_error(sentence);
    }
    return std::move(found_);
  }

 private:
  bool wanted(const std::string& name) const {
    return names_.empty() || std::count(names_.begin(), names_.end(), name) > 0;
  }

  std::vector<std::string> names_;
  StereoSets found_;
};

}  // namespace

StereoSets load_stereo_sets(const std::vector<std::string>& names) {
  Loader loader(names);
  loader.add_middlebury();
  loader.add_motorcycle();
  loader.add_aloe();
  return loader.take();
}

}  // namespace stereod::bench
