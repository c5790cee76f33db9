// SPDX-License-Identifier: BSD-3-Clause
// A street as a car or a robot sees it, rendered: there is no street among the sets with ground truth.
#pragma once

#include <array>
#include <opencv2/core.hpp>

#include "tests/bench/stereo_sets.h"

namespace stereod::bench {

/// The object that a pixel of the street shows; kSky has no ground truth.
enum class StreetPart : unsigned char { kRoad, kPavement, kFacade, kPlainFacade, kPole, kCar, kSky };
inline constexpr std::array<const char*, 6> kStreetParts{"road",         "pavement", "facade with joints",
                                                         "plain facade", "poles",    "parked car"};

struct Street {
  StereoSet set;
  cv::Mat1b part;  ///< StreetPart of each pixel of the left image
};

/// Renders the street: 640×480 px, focal length 500 px, cameras 0.24 m apart and 1.2 m above a road of
/// asphalt between kerbs; poles of 3 to 12 px on the pavements, a plain facade with windows at the left and
/// one of stones at the right. Fine texture fades with distance, the images have noise of σ 2. The same on
/// every run.
Street street();

}  // namespace stereod::bench
