// SPDX-License-Identifier: BSD-3-Clause
// Small statistics helpers.
#pragma once

#include <cstddef>
#include <vector>

namespace stereod::calib {

/// Returns the median of @p values [at least one]; of an even number the upper of the two middle values.
double median(std::vector<double> values);

/// Returns @p count indices below @p size, evenly spaced; @p count ≤ @p size.
std::vector<std::size_t> evenly_spaced(std::size_t count, std::size_t size);

}  // namespace stereod::calib
