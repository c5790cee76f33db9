// SPDX-License-Identifier: BSD-3-Clause
// Drawing of captioned panels.
#include "tests/bench/panels.h"

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace stereod::bench {
namespace {

constexpr int kPanelWidth = 240;
constexpr int kGap = 6;
constexpr int kCaption = 34;  // two lines

// `image` is of any size, blue, green and red.
cv::Mat captioned(const cv::Mat& image, const Caption& caption) {
  const int height = static_cast<int>(std::lround(1.0 * kPanelWidth * image.rows / image.cols));
  cv::Mat result(height + kCaption, kPanelWidth, CV_8UC3, cv::Scalar::all(255));
  cv::Mat scaled;
  cv::resize(image, scaled, {kPanelWidth, height}, 0, 0, cv::INTER_NEAREST);
  scaled.copyTo(result.rowRange(kCaption, result.rows));
  const cv::Scalar ink = cv::Scalar::all(40);
  cv::putText(result, caption.first_line, {2, 12}, cv::FONT_HERSHEY_SIMPLEX, 0.42, ink, 1, cv::LINE_AA);
  cv::putText(result, caption.second_line, {2, 28}, cv::FONT_HERSHEY_SIMPLEX, 0.36, ink, 1, cv::LINE_AA);
  return result;
}

}  // namespace

cv::Mat panel(const DisparityImage& disparity, int units_per_pixel, DisparityRange range,
              const Caption& caption) {
  DisparityRenderingOptions options;
  options.range = range;
  options.scale_bar = false;
  ColorImage colors = draw_disparity(disparity.view(), units_per_pixel, options);
  const cv::Mat whole(colors.height(), colors.width(), CV_8UC3, colors.row(0),
                      static_cast<std::size_t>(colors.view().stride()));
  cv::Mat blue_first;
  cv::cvtColor(whole, blue_first, cv::COLOR_RGB2BGR);
  return captioned(blue_first, caption);
}

cv::Mat row_of_panels(const std::vector<cv::Mat>& panels) {
  cv::Mat row(panels.front().rows, static_cast<int>(panels.size()) * (kPanelWidth + kGap) - kGap, CV_8UC3,
              cv::Scalar::all(255));
  for (std::size_t i = 0; i < panels.size(); ++i) {
    panels[i].copyTo(row(cv::Rect(static_cast<int>(i) * (kPanelWidth + kGap), 0, kPanelWidth, row.rows)));
  }
  return row;
}

void write_rows(const std::string& path, const std::vector<cv::Mat>& rows) {
  cv::Mat image;
  cv::vconcat(rows, image);
  if (!cv::imwrite(path, image, {cv::IMWRITE_PNG_COMPRESSION, 9})) {
    throw std::runtime_error(path + ": cannot be written");
  }
}

}  // namespace stereod::bench
