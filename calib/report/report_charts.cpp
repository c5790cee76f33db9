// SPDX-License-Identifier: BSD-3-Clause
#include "calib/report/report_charts.h"

#include <algorithm>
#include <cmath>

#include "calib/base/text.h"

namespace stereod::calib {

namespace {

std::string line(double x1, double y1, double x2, double y2, const std::string& css_class) {
  return "<line class=\"" + css_class + "\" x1=\"" + fixed(x1, 1) + "\" y1=\"" + fixed(y1, 1) + "\" x2=\"" +
         fixed(x2, 1) + "\" y2=\"" + fixed(y2, 1) + "\"/>";
}

std::string label(double x, double y, const std::string& css_class, const std::string& text) {
  return "<text class=\"" + css_class + "\" x=\"" + fixed(x, 1) + "\" y=\"" + fixed(y, 1) + "\">" +
         escape_html(text) + "</text>";
}

// A chart with logarithmic axes: depth 0.5…10 m to the right, error upward.
struct LogChart {
  static constexpr double kWidth = 640, kHeight = 300, kLeft = 70, kRight = 20, kTop = 16, kBottom = 44;
  double min_error, max_error;  // [m]

  double x(double depth) const {
    return kLeft + (kWidth - kLeft - kRight) * std::log(depth / 0.5) / std::log(10 / 0.5);
  }
  double y(double error) const {
    return kHeight - kBottom -
           (kHeight - kTop - kBottom) * std::log(error / min_error) / std::log(max_error / min_error);
  }
};

}  // namespace

std::string coverage_map(const SolveResult& result, const Coverage& coverage, bool left) {
  const Size image = result.calibration.image;
  const double w = image.width, h = image.height;
  std::string svg = "<svg class=\"map\" viewBox=\"0 0 " + fixed(w, 0) + " " + fixed(h, 0) +
                    "\"><rect class=\"ground\" width=\"" + fixed(w, 0) + "\" height=\"" + fixed(h, 0) +
                    "\"/>";
  const double cell_w = w / Coverage::kColumns, cell_h = h / Coverage::kRows;
  for (int row = 0; row < Coverage::kRows; ++row) {
    for (int column = 0; column < Coverage::kColumns; ++column) {
      const int count = coverage.count(column, row);
      const double strength = count == 0 ? 1 : std::min(1.0, 0.12 + count / 60.0);
      svg += "<rect class=\"" + std::string(count == 0 ? "empty" : "cell") + "\" x=\"" +
             fixed(column * cell_w, 1) + "\" y=\"" + fixed(row * cell_h, 1) + "\" width=\"" +
             fixed(cell_w, 1) + "\" height=\"" + fixed(cell_h, 1) +
             "\" style=\"fill-opacity:" + fixed(strength, 2) + "\"/>";
    }
  }
  const std::string radius = fixed(w / 260, 2);
  for (const PairResult& pair : result.pairs) {
    if (pair.outcome == PairOutcome::kRejected) continue;
    for (const Point2& p : left ? pair.corners.left : pair.corners.right) {
      svg += "<circle class=\"used\" cx=\"" + fixed(p.x, 1) + "\" cy=\"" + fixed(p.y, 1) + "\" r=\"" +
             radius + "\"/>";
    }
  }
  return svg + "</svg>";
}

std::string depth_chart(const Calibration& calibration, const DepthErrorSources& sources) {
  LogChart chart{1, 1};
  chart.min_error = std::pow(10, std::floor(std::log10(expected_depth_error_m(calibration, sources, 0.5))));
  chart.max_error = std::pow(10, std::ceil(std::log10(expected_depth_error_m(calibration, sources, 10))));
  chart.max_error = std::max(chart.max_error, 10 * chart.min_error);
  std::string svg = "<svg class=\"chart\" viewBox=\"0 0 640 300\">";
  for (double error = chart.min_error; error < chart.max_error * 1.01; error *= 10) {
    svg += line(chart.kLeft, chart.y(error), chart.kWidth - chart.kRight, chart.y(error), "grid");
    svg += label(chart.kLeft - 8, chart.y(error) + 4, "left-label",
                 error < 0.0099 ? fixed(1000 * error, 0) + " mm"
                 : error < 0.99 ? fixed(100 * error, 0) + " cm"
                                : fixed(error, 0) + " m");
  }
  std::string points;
  for (int step = 0; step <= 60; ++step) {
    const double depth = 0.5 * std::pow(20.0, step / 60.0);
    points += fixed(chart.x(depth), 1) + "," +
              fixed(chart.y(expected_depth_error_m(calibration, sources, depth)), 1) + " ";
  }
  for (const double depth : kReportedDepths_m) {
    svg += line(chart.x(depth), chart.kTop, chart.x(depth), chart.kHeight - chart.kBottom, "grid");
    svg += label(chart.x(depth), chart.kHeight - chart.kBottom + 22, "middle-label",
                 fixed(depth, depth < 1 ? 1 : 0) + " m");
  }
  svg += "<polyline class=\"curve\" points=\"" + points + "\"/>";
  for (const double depth : kReportedDepths_m) {
    svg += "<circle class=\"dot\" cx=\"" + fixed(chart.x(depth), 1) + "\" cy=\"" +
           fixed(chart.y(expected_depth_error_m(calibration, sources, depth)), 1) + "\" r=\"4.5\"/>";
  }
  svg += label((chart.kLeft + chart.kWidth - chart.kRight) / 2, chart.kHeight - 4, "middle-label", "depth");
  return svg + "</svg>";
}

std::string epipolar_view(const Calibration& calibration, const BoardPair& corners,
                          const std::string& left_url, const std::string& right_url) {
  const double w = calibration.image.width, h = calibration.image.height, gap = w / 80;
  const std::string size = "width=\"" + fixed(w, 0) + "\" height=\"" + fixed(h, 0) + "\"";
  std::string svg = "<svg class=\"pair\" viewBox=\"0 0 " + fixed(2 * w + gap, 1) + " " + fixed(h, 0) + "\">";
  svg += "<image " + size + " href=\"" + left_url + "\"/>";
  svg += "<image " + size + " x=\"" + fixed(w + gap, 1) + "\" href=\"" + right_url + "\"/>";
  constexpr int kLines = 16;
  for (int i = 0; i < kLines; ++i) {
    const double y = h * (i + 0.5) / kLines;
    svg += line(0, y, 2 * w + gap, y, i % 2 == 0 ? "epipolar even" : "epipolar odd");
  }
  const auto mark = [&](const CameraCalibration& camera, const Corners& list, double offset) {
    for (const Point2& p : list) {
      const auto at = rectified_point(camera, p);
      if (!at || at->x < 0 || at->x > w || at->y < 0 || at->y > h) continue;
      svg += "<circle class=\"corner\" cx=\"" + fixed(at->x + offset, 1) + "\" cy=\"" + fixed(at->y, 1) +
             "\" r=\"" + fixed(w / 160, 1) + "\"/>";
    }
  };
  mark(calibration.left, corners.left, 0);
  mark(calibration.right, corners.right, w + gap);
  return svg + "</svg>";
}

std::string bar(double value, double full, const std::string& css_class) {
  const double share = full > 0 ? std::clamp(value / full, 0.0, 1.0) : 0;
  return "<span class=\"bar\"><span class=\"" + css_class + "\" style=\"width:" + fixed(100 * share, 1) +
         "%\"></span></span>";
}

}  // namespace stereod::calib
