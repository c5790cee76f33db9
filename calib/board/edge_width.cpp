// SPDX-License-Identifier: BSD-3-Clause
#include "calib/board/edge_width.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "calib/base/statistics.h"

namespace stereod::calib {

namespace {

double gray_at(GrayView image, Point2 p) {
  const double x = std::clamp(p.x, 0.0, image.width() - 1.001),
               y = std::clamp(p.y, 0.0, image.height() - 1.001);
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const double u = x - column, v = y - row;
  const auto pixel = [&](int dx, int dy) -> double {
    return image.at(std::min(column + dx, image.width() - 1), std::min(row + dy, image.height() - 1));
  };
  return (1 - v) * ((1 - u) * pixel(0, 0) + u * pixel(1, 0)) + v * ((1 - u) * pixel(0, 1) + u * pixel(1, 1));
}

// Returns the edge width along the line from middle − half_way to middle + half_way, which crosses the edge.
double width_across(GrayView image, Point2 middle, Point2 half_way) {
  constexpr int kSteps = 40;  // samples on each side
  std::array<double, 2 * kSteps + 1> samples{};
  for (int step = -kSteps; step <= kSteps; ++step) {
    const double part = static_cast<double>(step) / kSteps;
    samples[static_cast<std::size_t>(step + kSteps)] =
        gray_at(image, {middle.x + part * half_way.x, middle.y + part * half_way.y});
  }
  const double from = (samples[0] + samples[1] + samples[2]) / 3;
  const double to = (samples[2 * kSteps] + samples[2 * kSteps - 1] + samples[2 * kSteps - 2]) / 3;
  const double length = 2 * std::hypot(half_way.x, half_way.y);
  const double step_height = to - from;
  if (std::abs(step_height) < 10) return length;
  // Samples between 10 and 90 % of the step lie within the edge.
  const auto within = std::count_if(samples.begin(), samples.end(), [&](double gray) {
    const double part = (gray - from) / step_height;
    return part > 0.1 && part < 0.9;
  });
  return length * static_cast<double>(within) / (2 * kSteps + 1);
}

}  // namespace

double edge_width_px(GrayView image, const Board& board, const Corners& corners) {
  const auto columns = static_cast<std::size_t>(board.columns), rows = static_cast<std::size_t>(board.rows);
  const auto at = [&](std::size_t column, std::size_t row) { return corners[row * columns + column]; };
  const auto across = [&](Point2 a, Point2 b, Point2 next_to_a, Point2 next_to_b) {
    // Half a square to each side of the edge from a to b, along the edges that leave a and b.
    const Point2 half{0.25 * (next_to_a.x - a.x + next_to_b.x - b.x),
                      0.25 * (next_to_a.y - a.y + next_to_b.y - b.y)};
    return width_across(image, {(a.x + b.x) / 2, (a.y + b.y) / 2}, half);
  };
  std::vector<double> horizontal, vertical;
  for (std::size_t row = 0; row + 1 < rows; ++row) {
    for (std::size_t column = 0; column + 1 < columns; ++column) {
      horizontal.push_back(
          across(at(column, row), at(column + 1, row), at(column, row + 1), at(column + 1, row + 1)));
      vertical.push_back(
          across(at(column, row), at(column, row + 1), at(column + 1, row), at(column + 1, row + 1)));
    }
  }
  return std::max(median(std::move(horizontal)), median(std::move(vertical)));
}

double blur_limit_px(Size image) {
  constexpr double kSharp_px = 2.5;
  constexpr double kBlur = 0.0085;  // allowed blur, share of the longer side
  return std::hypot(kSharp_px, kBlur * std::max(image.width, image.height));
}

}  // namespace stereod::calib
