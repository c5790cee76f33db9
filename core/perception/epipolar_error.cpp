// SPDX-License-Identifier: BSD-3-Clause
#include "core/perception/epipolar_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace stereod {

namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::optional<EpipolarError> epipolar_error(std::span<const EpipolarMatch> matches, Size image) {
  constexpr std::size_t kMin = 40, kMinInPart = 8;
  if (matches.size() < kMin) return std::nullopt;
  EpipolarError result;
  std::vector<double> all;
  std::array<std::vector<double>, 9> parts;
  for (const EpipolarMatch& match : matches) {
    const int column = std::clamp(static_cast<int>(3 * match.x / static_cast<float>(image.width)), 0, 2);
    const int row = std::clamp(static_cast<int>(3 * match.y / static_cast<float>(image.height)), 0, 2);
    parts[static_cast<std::size_t>(3 * row + column)].push_back(match.row_offset_px);
    all.push_back(match.row_offset_px);
  }
  double sum = 0;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    if (parts[part].size() < kMinInPart) continue;
    const double offset = std::abs(median(parts[part]));
    result.points += parts[part].size();
    sum += offset * static_cast<double>(parts[part].size());
    if (offset > result.worst_px) result.worst_px = offset, result.worst_part = static_cast<int>(part);
  }
  if (result.points < kMin / 2) return std::nullopt;
  result.epipolar_error_px = sum / static_cast<double>(result.points);
  result.row_offset_px = median(all);
  return result;
}

std::optional<EpipolarError> clear_misalignment(std::span<const EpipolarMatch> matches) {
  constexpr std::size_t kMin = 12;
  constexpr double kApart_px = 1.5;
  if (matches.size() < kMin) return std::nullopt;
  std::vector<double> offsets, sizes;
  std::size_t apart = 0;
  for (const EpipolarMatch& match : matches) {
    offsets.push_back(match.row_offset_px);
    sizes.push_back(std::abs(offsets.back()));
    apart += sizes.back() > kApart_px ? 1U : 0U;
  }
  if (5 * apart < 4 * matches.size()) return std::nullopt;
  EpipolarError result;
  result.points = matches.size();
  result.epipolar_error_px = result.worst_px = median(sizes);
  result.row_offset_px = median(offsets);
  return result;
}

}  // namespace stereod
