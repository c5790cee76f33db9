// SPDX-License-Identifier: BSD-3-Clause
// What a real rig sees, rectified by our own calibration and matched: there is no truth, only to look at.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace stereod::bench {

/// A row of panels for each of `scenes`, images `directory`/left_SCENE.png and right_SCENE.png of the cameras
/// that `calibration` (a file) is of: OpenCV's BM and SGBM 3WAY, dense, robust and fine, each with the share
/// of the pixels that it answers. The photographs are not drawn: they are not ours to pass on. Throws
/// FileError.
std::vector<cv::Mat> rig_scene_rows(const std::filesystem::path& calibration,
                                    const std::filesystem::path& directory,
                                    const std::vector<std::string>& scenes);

}  // namespace stereod::bench
