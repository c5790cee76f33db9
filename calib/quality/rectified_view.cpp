// SPDX-License-Identifier: BSD-3-Clause
#include "calib/quality/rectified_view.h"

#include <opencv2/imgproc.hpp>

#include "calib/base/opencv_image.h"

namespace stereod::calib {

GrayImage rectified_view(const CameraCalibration& camera, GrayView image) {
  cv::Mat map(image.height(), image.width(), CV_32FC2);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const auto p = source_point(camera, {static_cast<double>(x), static_cast<double>(y)});
      map.at<cv::Vec2f>(y, x) =
          p ? cv::Vec2f(static_cast<float>(p->x), static_cast<float>(p->y)) : cv::Vec2f(-10, -10);
    }
  }
  GrayImage result(image.width(), image.height());
  cv::Mat out = as_opencv(result.view());
  cv::remap(as_opencv(image), out, map, cv::noArray(), cv::INTER_LINEAR);
  return result;
}

}  // namespace stereod::calib
