// SPDX-License-Identifier: BSD-3-Clause
// Diagrams of subpixel errors.
#include "tests/bench/subpixel_plot.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

namespace stereod::bench {
namespace {

constexpr int kDiagramWidth = 380;
constexpr int kDiagramHeight = 240;
constexpr int kMarginLeft = 70;
constexpr int kMarginTop = 60;
constexpr int kCellWidth = kDiagramWidth + kMarginLeft + 30;
constexpr int kCellHeight = kDiagramHeight + kMarginTop + 50;

// Blue, green, red; a color-blind reader tells them apart by their lightness.
const std::array<cv::Scalar, 3> kColors{cv::Scalar(180, 90, 0), cv::Scalar(70, 170, 90),
                                        cv::Scalar(60, 60, 220)};
const cv::Scalar kInk(60, 60, 60);
const cv::Scalar kGrid(220, 220, 220);

void write(cv::Mat& image, const std::string& text, cv::Point at, const cv::Scalar& color = kInk) {
  cv::putText(image, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.42, color, 1, cv::LINE_AA);
}

/// Axes over [0, 1) px and [low, high], and the position of a value between them.
class Diagram {
 public:
  Diagram(cv::Mat& image, cv::Point corner, double low, double high)
      : image_(image), corner_(corner + cv::Point(kMarginLeft, kMarginTop)), low_(low), high_(high) {}

  cv::Point at(double x, double y) const {
    return corner_ + cv::Point(static_cast<int>(std::lround(x * kDiagramWidth)),
                               static_cast<int>(std::lround((high_ - y) / (high_ - low_) * kDiagramHeight)));
  }

  void draw_axes(const std::string& title, double step, const char* format) {
    write(image_, title, corner_ + cv::Point(0, -38));
    for (double y = low_; y <= high_ + step / 2; y += step) {
      cv::line(image_, at(0, y), at(1, y), kGrid);
      std::array<char, 32> text{};
      std::snprintf(text.data(), text.size(), format, std::fabs(y) < step / 2 ? 0.0 : y);
      write(image_, text.data(), at(0, y) + cv::Point(-58, 4));
    }
    for (const auto& [x, text] :
         {std::pair{0.0, "0"}, {0.25, "1/4"}, {0.5, "1/2"}, {0.75, "3/4"}, {1.0, "1"}}) {
      cv::line(image_, at(x, low_), at(x, high_), kGrid);
      write(image_, text, at(x, low_) + cv::Point(-8, 18));
    }
    write(image_, "part of a pixel", at(0.5, low_) + cv::Point(-50, 36));
  }

  void draw_ideal(double y) { cv::line(image_, at(0, y), at(1, y), kInk); }

  void draw(const std::vector<cv::Point2d>& values, const cv::Scalar& color) {
    for (std::size_t i = 1; i < values.size(); ++i) {
      cv::line(image_, at(values[i - 1].x, values[i - 1].y), at(values[i].x, values[i].y), color, 2,
               cv::LINE_AA);
    }
  }

  void name_curve(std::size_t number, const std::string& name) {
    const cv::Point place = corner_ + cv::Point(static_cast<int>(number) * 130, -16);
    cv::line(image_, place + cv::Point(0, -4), place + cv::Point(14, -4), kColors[number], 2, cv::LINE_AA);
    write(image_, name, place + cv::Point(18, 0), kColors[number]);
  }

 private:
  cv::Mat& image_;
  cv::Point corner_;
  double low_, high_;
};

template <std::size_t N>
std::vector<cv::Point2d> once_around(const std::array<double, N>& values) {
  std::vector<cv::Point2d> points;
  for (std::size_t i = 0; i <= N; ++i) points.emplace_back(static_cast<double>(i) / N, values[i % N]);
  return points;
}

}  // namespace

cv::Mat draw_subpixel(const std::vector<SubpixelPanel>& panels) {
  cv::Mat image(static_cast<int>(panels.size()) * kCellHeight, 2 * kCellWidth, CV_8UC3, cv::Scalar::all(255));
  for (std::size_t row = 0; row < panels.size(); ++row) {
    const SubpixelPanel& panel = panels[row];
    const int top = static_cast<int>(row) * kCellHeight;
    Diagram errors(image, {0, top}, -0.12, 0.12);
    Diagram shares(image, {kCellWidth, top}, 0, 0.16);
    errors.draw_axes("mean error, px (" + panel.title + ")", 0.04, "%+.2f");
    shares.draw_axes("share of the answers (" + panel.title + ")", 0.04, "%.2f");
    errors.draw_ideal(0);
    shares.draw_ideal(1.0 / kSubpixelUnits);
    for (std::size_t i = 0; i < panel.curves.size(); ++i) {
      errors.draw(once_around(panel.curves[i].bias.mean_error), kColors.at(i));
      shares.draw(once_around(panel.curves[i].bias.share), kColors.at(i));
      errors.name_curve(i, panel.curves[i].name);
      shares.name_curve(i, panel.curves[i].name);
    }
  }
  return image;
}

}  // namespace stereod::bench
