// SPDX-License-Identifier: BSD-3-Clause
// Stereo pairs whose true disparities are known.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "core/base/image.h"

namespace stereod::bench {

struct StereoSet {
  std::string name;
  cv::Mat left, right;  ///< gray, rectified, both of the same size
  Image<float> truth;   ///< px in the left image; unknown is +infinity
  int disparities = 0;  ///< how many to search, from 0; a multiple of 16, as OpenCV wants it
};

struct StereoSets {
  std::vector<StereoSet> sets;
  std::vector<std::string> missing;  ///< what is not there and how to get it
};

/// Loads the Middlebury sets of datasets(), by name, then Motorcycle (Debian's package python3-skimage, or
/// the directory STEREO_SKIMAGE_DATA) and Aloe (opencv-doc). @p names restricts them; empty means all. Throws
/// FileError for a set that cannot be read, std::runtime_error for an unknown name.
StereoSets load_stereo_sets(const std::vector<std::string>& names);

}  // namespace stereod::bench
