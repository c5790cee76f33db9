// SPDX-License-Identifier: BSD-3-Clause
// The images that are measured on, and the bridge to OpenCV.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>

#include "core/base/image.h"

namespace stereod::bench {

struct MatPair {
  cv::Mat left, right;
};

/// Where the data sets are: STEREO_DATASETS, or shared/datasets beside the source tree.
std::filesystem::path datasets();

/// The thesis' images: Tsukuba, 384×288, gray. Nothing if the data set is not there.
std::optional<MatPair> load_tsukuba();

/// Aloe (Debian's package opencv-doc), scaled to `size`, 24-bit color. Nothing if the package is not
/// installed.
std::optional<MatPair> load_aloe(cv::Size size);
std::optional<MatPair> load_aloe_vga();  ///< 640×480

cv::Mat gray_of(const cv::Mat& color);

/// The same memory in our words. A gray or 24-bit image; `mat` stays the owner.
GrayView view_of(const cv::Mat& mat);

}  // namespace stereod::bench
