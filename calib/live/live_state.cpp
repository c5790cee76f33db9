// SPDX-License-Identifier: BSD-3-Clause
#include "calib/live/live_state.h"

#include <algorithm>

#include "calib/base/text.h"
#include "daemon/base/progress.h"

namespace stereod::calib {

namespace {

std::vector<int> cells_of(const Coverage& coverage) {
  std::vector<int> cells;
  for (int row = 0; row < Coverage::kRows; ++row) {
    for (int column = 0; column < Coverage::kColumns; ++column) cells.push_back(coverage.count(column, row));
  }
  return cells;
}

std::string json_of(const std::vector<int>& values) {
  std::string text = "[";
  for (const int value : values) text += (text.size() > 1 ? "," : "") + std::to_string(value);
  return text + "]";
}

std::string json_of(const Corners& corners) {
  std::string text = "[";
  for (const Point2& p : corners) {
    text += (text.size() > 1 ? ",[" : "[") + fixed(p.x, 1) + "," + fixed(p.y, 1) + "]";
  }
  return text + "]";
}

}  // namespace

LiveSnapshot snapshot_of(const CaptureGuide& guide, const CaptureGuide::Instruction& instruction,
                         const Corners& left, const Corners& right, Size image) {
  return {image,
          left,
          right,
          instruction.words,
          guide.taken(),
          guide.wanted(),
          guide.left_coverage().share(),
          guide.right_coverage().share(),
          cells_of(guide.left_coverage()),
          cells_of(guide.right_coverage())};
}

std::string status_line(const LiveSnapshot& m) {
  const auto done = static_cast<std::size_t>(std::min(m.taken, m.wanted));
  return progress_bar(done, static_cast<std::size_t>(m.wanted), 15) + " " + std::to_string(m.taken) + "/" +
         std::to_string(m.wanted) + " pairs | board: left " + (m.left.empty() ? "no " : "yes") + " right " +
         (m.right.empty() ? "no " : "yes") + " | coverage " +
         fixed(100 * std::min(m.left_coverage, m.right_coverage), 0) + " % | " + m.words;
}

// Needs no escaping: CaptureGuide writes the words.
std::string json_of(const LiveSnapshot& m) {
  return "{\"width\":" + std::to_string(m.image.width) + ",\"height\":" + std::to_string(m.image.height) +
         ",\"words\":\"" + m.words + "\",\"taken\":" + std::to_string(m.taken) +
         ",\"wanted\":" + std::to_string(m.wanted) + ",\"columns\":" + std::to_string(Coverage::kColumns) +
         ",\"rows\":" + std::to_string(Coverage::kRows) + ",\"left\":{\"corners\":" + json_of(m.left) +
         ",\"cells\":" + json_of(m.left_cells) + ",\"coverage\":" + fixed(m.left_coverage, 3) +
         "},\"right\":{\"corners\":" + json_of(m.right) + ",\"cells\":" + json_of(m.right_cells) +
         ",\"coverage\":" + fixed(m.right_coverage, 3) + "}}";
}

}  // namespace stereod::calib
