// SPDX-License-Identifier: BSD-3-Clause
// The state of a live capture that the terminal and the page show.
#pragma once

#include <string>
#include <vector>

#include "calib/live/capture_guide.h"

namespace stereod::calib {

/// A snapshot of the capture.
struct LiveSnapshot {
  Size image;
  Corners left, right;  ///< empty where the board is not seen
  std::string words;    ///< CaptureGuide::Instruction::words
  int taken = 0, wanted = 0;
  double left_coverage = 0, right_coverage = 0;  ///< 0…1
  std::vector<int> left_cells, right_cells;      ///< corners in each cell of Coverage, row by row
};

LiveSnapshot snapshot_of(const CaptureGuide& guide, const CaptureGuide::Instruction& instruction,
                         const Corners& left, const Corners& right, Size image);

/// Returns "[####......] 4/15 pairs | board: left yes right no  | coverage 31 % | hold still".
std::string status_line(const LiveSnapshot& snapshot);

/// Returns the snapshot as JSON for the page.
std::string json_of(const LiveSnapshot& snapshot);

}  // namespace stereod::calib
