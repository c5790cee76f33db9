// SPDX-License-Identifier: BSD-3-Clause
#include "calib/base/statistics.h"

#include <algorithm>

namespace stereod::calib {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<std::size_t> evenly_spaced(std::size_t count, std::size_t size) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < count; ++i) indices.push_back((2 * i + 1) * size / (2 * count));
  return indices;
}

}  // namespace stereod::calib
