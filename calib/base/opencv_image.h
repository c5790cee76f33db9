// Our images as OpenCV's and back.
#pragma once

#include <opencv2/core.hpp>

#include "core/base/image.h"

namespace stereod {

/// The same memory, which OpenCV promises only to read.
inline cv::Mat as_opencv(GrayView picture) {
  return {picture.height(), picture.width(), CV_8UC1, const_cast<std::uint8_t*>(picture.row(0)),
          static_cast<std::size_t>(picture.stride())};
}

/// The same memory, to be written to.
inline cv::Mat as_opencv(ImageView<std::uint8_t> picture) {
  return {picture.height(), picture.width(), CV_8UC1, picture.row(0),
          static_cast<std::size_t>(picture.stride())};
}

}  // namespace stereod
