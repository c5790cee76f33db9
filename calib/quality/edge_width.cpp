#include "calib/quality/edge_width.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace stereod {

namespace {

double gray_at(GrayView picture, Point2 p) {
  const double x = std::clamp(p.x, 0.0, picture.width() - 1.001),
               y = std::clamp(p.y, 0.0, picture.height() - 1.001);
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const double u = x - column, v = y - row;
  const auto pixel = [&](int dx, int dy) -> double {
    return picture.at(std::min(column + dx, picture.width() - 1), std::min(row + dy, picture.height() - 1));
  };
  return (1 - v) * ((1 - u) * pixel(0, 0) + u * pixel(1, 0)) + v * ((1 - u) * pixel(0, 1) + u * pixel(1, 1));
}

// Across the edge through `middle`, from one side's square to the other's.
double width_across(GrayView picture, Point2 middle, Point2 half_way) {
  constexpr int kSteps = 40;  // to each side
  std::array<double, 2 * kSteps + 1> greys{};
  for (int step = -kSteps; step <= kSteps; ++step) {
    const double part = static_cast<double>(step) / kSteps;
    greys[static_cast<std::size_t>(step + kSteps)] =
        gray_at(picture, {middle.x + part * half_way.x, middle.y + part * half_way.y});
  }
  const double from = (greys[0] + greys[1] + greys[2]) / 3;
  const double to = (greys[2 * kSteps] + greys[2 * kSteps - 1] + greys[2 * kSteps - 2]) / 3;
  const double length = 2 * std::hypot(half_way.x, half_way.y);
  const double step_height = to - from;
  if (std::abs(step_height) < 10) return length;
  // Each gray between 10 and 90 % of the step is a place within the edge.
  const auto within = std::count_if(greys.begin(), greys.end(), [&](double gray) {
    const double part = (gray - from) / step_height;
    return part > 0.1 && part < 0.9;
  });
  return length * static_cast<double>(within) / (2 * kSteps + 1);
}

double median_of(std::vector<double>& widths) {
  const auto middle = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
  std::nth_element(widths.begin(), middle, widths.end());
  return *middle;
}

}  // namespace

double edge_width_px(GrayView picture, const Board& board, const Corners& corners) {
  const auto columns = static_cast<std::size_t>(board.columns), rows = static_cast<std::size_t>(board.rows);
  const auto at = [&](std::size_t column, std::size_t row) { return corners[row * columns + column]; };
  const auto across = [&](Point2 a, Point2 b, Point2 beside_a, Point2 beside_b) {
    // Half a square to each side of the edge from a to b, along the edges that leave it.
    const Point2 half{0.25 * (beside_a.x - a.x + beside_b.x - b.x),
                      0.25 * (beside_a.y - a.y + beside_b.y - b.y)};
    return width_across(picture, {(a.x + b.x) / 2, (a.y + b.y) / 2}, half);
  };
  std::vector<double> lying, standing;
  for (std::size_t row = 0; row + 1 < rows; ++row) {
    for (std::size_t column = 0; column + 1 < columns; ++column) {
      lying.push_back(
          across(at(column, row), at(column + 1, row), at(column, row + 1), at(column + 1, row + 1)));
      standing.push_back(
          across(at(column, row), at(column, row + 1), at(column + 1, row), at(column + 1, row + 1)));
    }
  }
  return std::max(median_of(lying), median_of(standing));
}

double blur_limit_px(Size image) {
  constexpr double kSharp_px = 2.5;
  constexpr double kBlur = 0.0085;  // of the longer side
  return std::hypot(kSharp_px, kBlur * std::max(image.width, image.height));
}

}  // namespace stereod
