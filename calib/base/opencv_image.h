// SPDX-License-Identifier: BSD-3-Clause
// Views of images as cv::Mat, without copying.
#pragma once

#include <opencv2/core.hpp>

#include "core/base/image.h"

namespace stereod::calib {

/// Returns a cv::Mat over the memory of @p image. The caller must only read through it.
inline cv::Mat as_opencv(GrayView image) {
  return {image.height(), image.width(), CV_8UC1, const_cast<std::uint8_t*>(image.row(0)),
          static_cast<std::size_t>(image.stride())};
}

/// Returns a writable cv::Mat over the memory of @p image.
inline cv::Mat as_opencv(ImageView<std::uint8_t> image) {
  return {image.height(), image.width(), CV_8UC1, image.row(0), static_cast<std::size_t>(image.stride())};
}

}  // namespace stereod::calib
