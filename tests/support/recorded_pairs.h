// SPDX-License-Identifier: BSD-3-Clause
// Recordings for tests: pairs of the synthetic scene as files.
#pragma once

#include <filesystem>

#include "core/base/image.h"

namespace stereod {

/// Writes @p count raw pairs of the synthetic scene as left_NN.png and right_NN.png into @p directory, and
/// the cameras' calibration as calibration.yaml.
void write_recorded_pairs(const std::filesystem::path& directory, Size size, int count);

/// Returns the file names of pair @p number.
std::filesystem::path recorded_left(const std::filesystem::path& directory, int number);
std::filesystem::path recorded_right(const std::filesystem::path& directory, int number);

}  // namespace stereod
