// What a live session shows, in the terminal and on the page.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "calib/guidance.h"

namespace stereod {

/// A moment of the session.
struct LiveMoment {
  Size image;
  Corners left, right;  ///< empty where the board is not seen
  std::string words;    ///< what to do
  int taken = 0, wanted = 0;
  double left_coverage = 0, right_coverage = 0;  ///< 0 … 1
  std::vector<int> left_cells, right_cells;      ///< corners in each of Coverage's cells, row by row
};

LiveMoment moment_of(const Guide& guide, const Guide::Advice& advice, const Corners& left,
                     const Corners& right, Size image);

/// "[####......] 4/15 pairs | left yes, right no | coverage 31 % | hold still".
std::string status_line(const LiveMoment& moment);

/// The moment as JSON for the page.
std::string json_of(const LiveMoment& moment);

}  // namespace stereod
