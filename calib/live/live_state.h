// What a live session shows, in the terminal and on the page.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "calib/live/capture_guide.h"

namespace stereod {

/// A moment of the session.
struct LiveSnapshot {
  Size image;
  Corners left, right;  ///< empty where the board is not seen
  std::string words;    ///< what to do
  int taken = 0, wanted = 0;
  double left_coverage = 0, right_coverage = 0;  ///< 0 … 1
  std::vector<int> left_cells, right_cells;      ///< corners in each of Coverage's cells, row by row
};

LiveSnapshot snapshot_of(const CaptureGuide& guide, const CaptureGuide::Instruction& instruction,
                         const Corners& left, const Corners& right, Size image);

/// "[####......] 4/15 pairs | left yes, right no | coverage 31 % | hold still".
std::string status_line(const LiveSnapshot& snapshot);

/// The moment as JSON for the page.
std::string json_of(const LiveSnapshot& snapshot);

}  // namespace stereod
