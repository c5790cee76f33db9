// SPDX-License-Identifier: BSD-3-Clause
// Scenes of a real rig, rectified by our own calibration and matched; they have no ground truth.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace stereod::bench {

/// Draws a row of panels for each of @p scenes, the images left_SCENE.png and right_SCENE.png in
/// @p directory, taken with the cameras of the file @p calibration: OpenCV's BM and SGBM 3WAY, dense, robust
/// and fine, each with the share of matched pixels. Does not draw the photographs, which belong to others.
/// Throws FileError.
std::vector<cv::Mat> rig_scene_rows(const std::filesystem::path& calibration,
                                    const std::filesystem::path& directory,
                                    const std::vector<std::string>& scenes);

}  // namespace stereod::bench
