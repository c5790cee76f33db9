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

/// Returns the directory of the data sets: STEREO_DATASETS, or shared/datasets beside the source tree.
std::filesystem::path datasets();

/// Returns the thesis' images: Tsukuba, 384×288, gray; empty if the data set is missing.
std::optional<MatPair> load_tsukuba();

/// Returns Aloe (Debian's package opencv-doc), scaled to @p size, 24-bit color; empty if the package is not
/// installed.
std::optional<MatPair> load_aloe(cv::Size size);
std::optional<MatPair> load_aloe_vga();  ///< 640×480

cv::Mat gray_of(const cv::Mat& color);

/// Returns a view of @p mat, a gray or 24-bit image, which keeps the ownership.
GrayView view_of(const cv::Mat& mat);

}  // namespace stereod::bench
