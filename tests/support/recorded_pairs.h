// Recordings for tests: pairs of the synthetic scene as files.
#pragma once

#include <filesystem>

#include "core/base/image.h"

namespace stereod {

/// Writes `count` raw pairs of the synthetic scene as left_NN.png and right_NN.png into `directory`, and the
/// cameras' calibration as calibration.yaml.
void write_recorded_pairs(const std::filesystem::path& directory, Size size, int count);

/// The names of pair `number`.
std::filesystem::path recorded_left(const std::filesystem::path& directory, int number);
std::filesystem::path recorded_right(const std::filesystem::path& directory, int number);

}  // namespace stereod
