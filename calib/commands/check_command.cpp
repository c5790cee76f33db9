#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>

#include "calib/base/errors.h"
#include "calib/base/pair_input.h"
#include "calib/board/board_search.h"
#include "calib/commands/commands.h"
#include "calib/commands/feed_options.h"
#include "calib/quality/coverage.h"
#include "calib/quality/depth_error.h"
#include "calib/quality/epipolar_matches.h"
#include "calib/quality/rectified_view.h"
#include "calib/quality/verdict.h"
#include "calib/report/html.h"
#include "calib/solve/camera_solver.h"
#include "core/base/text.h"
#include "daemon/base/progress.h"
#include "daemon/config/calibration_file.h"

namespace stereod {

namespace {

struct Flags {
  std::filesystem::path calibration;
  PairInput input;
  FeedFlags feed;
  int pairs = 10;
  std::string board = "auto", square;
};

// Not to be taken for a board that was none.
struct InteropError : CalibrationError {
  using CalibrationError::CalibrationError;
};

// What was measured, with a board or without.
struct Measured {
  double epipolar_error_px = 0;
  std::string how;         // a sentence
  double scale_error = 0;  // 0 if the square is not known
  bool scale_known = false;
};

Measured with_board(const Calibration& calibration, const std::vector<ImagePair>& pictures, Board board,
                    const std::string& square) {
  if (!square.empty()) board.square_m = parse_length(square, "--square");
  const bool sized = board.square_m > 0;
  if (!sized) board.square_m = 0.025;  // rows do not depend on it
  Measured result;
  double count = 0, behind = 0;
  for (std::size_t i = 0; const PairSearch& pair : search_boards(pictures, board)) {
    const std::string& name = pictures[i++].name;
    if (!pair.problem.empty()) {
      std::printf("%s: %s\n", name.c_str(), pair.problem.c_str());
      continue;
    }
    const BoardPose pose = solve_pose(calibration.left.camera, board, pair.corners.left);
    const PairCheck check = check_pair(calibration, board, pair.corners, pose);
    std::printf("%s: rows %.2f px apart\n", name.c_str(), check.epipolar_error_px);
    behind += check.behind > 0.5 ? 1 : 0;
    result.epipolar_error_px += check.epipolar_error_px;
    result.scale_error += check.scale_error;
    count += 1;
  }
  if (count == 0)
    throw CalibrationError("no pair shows the whole board in both images; there is nothing to check");
  if (behind == count) {
    throw InteropError(
        "by this calibration the board is behind the cameras in every pair; are left and right exchanged?");
  }
  result.epipolar_error_px /= count;
  result.scale_error /= count;
  result.scale_known = sized;
  result.how = "measured on a board of " + in_words(board) + " in " + fixed(count, 0) + " pairs";
  return result;
}

Measured without_board(const Calibration& calibration, const std::vector<ImagePair>& pictures) {
  std::vector<EpipolarMatch> all;
  {
    Progress progress("matching", pictures.size());
    for (const ImagePair& pair : pictures) {
      const auto matches = match_rows(rectified_view(calibration.left, pair.left.view()).view(),
                                      rectified_view(calibration.right, pair.right.view()).view());
      all.insert(all.end(), matches.begin(), matches.end());
      progress.step();
    }
  }
  const auto found = epipolar_error(all, calibration.image);
  if (!found) {
    throw CalibrationError(
        "only " + std::to_string(all.size()) +
        " points of the images were found again in their partners, too few to tell; show a "
        "scene with texture, or a board, or the calibration is off by many pixels");
  }
  Measured result;
  result.epipolar_error_px = found->epipolar_error_px;
  result.how = "measured on " + std::to_string(found->points) + " points of " +
               std::to_string(pictures.size()) + " pairs; worst in " + part_in_words(found->worst_part) +
               ", " + fixed(found->worst_px, 2) + " px";
  return result;
}

// So many pairs of the live images, one after the other; fewer only where a recording ends.
std::vector<ImagePair> live_pairs(const Flags& flags) {
  constexpr std::chrono::seconds kPatience{15};
  const std::unique_ptr<FrameFeed> feed = open_feed(flags.feed);
  std::vector<ImagePair> pictures;
  Progress progress("taking pairs", static_cast<std::size_t>(flags.pairs));
  while (static_cast<int>(pictures.size()) < flags.pairs && !feed->finished()) {
    std::optional<ImagePair> pair = feed->next(kPatience);
    if (!pair) {
      if (feed->finished()) break;
      throw CalibrationError("no pair of images came within " + std::to_string(kPatience.count()) + " s (" +
                             flags.feed.waiting_words() + ")");
    }
    if (!pictures.empty() && pair->left.size() != pictures.front().left.size()) {
      throw CalibrationError("the images changed their size while they were taken; begin again");
    }
    pictures.push_back(std::move(*pair));
    progress.step();
  }
  if (pictures.empty()) throw CalibrationError("the recording holds no pair of images");
  return pictures;
}

std::vector<ImagePair> pairs_of(const Flags& flags) {
  if (!flags.feed.any()) return read_pairs(flags.input);
  if (!flags.input.directory.empty() || !flags.input.left.empty() || !flags.input.right.empty() ||
      !flags.input.side_by_side.empty()) {
    throw UsageError("give either images, or --daemon or --config for live ones, not both");
  }
  return live_pairs(flags);
}

std::optional<Board> board_for(const Flags& flags, const std::vector<ImagePair>& pictures) {
  if (flags.board == "none") return std::nullopt;
  if (flags.board != "auto") return parse_board(flags.board);
  try {
    return guess_board(pictures);
  } catch (const CalibrationError&) {
    return std::nullopt;
  }
}

Measured measure(const Flags& flags, const Calibration& calibration, const std::vector<ImagePair>& pictures) {
  const auto board = board_for(flags, pictures);
  if (!board) return without_board(calibration, pictures);
  try {
    return with_board(calibration, pictures, *board, flags.square);
  } catch (const InteropError&) {
    throw;
  } catch (const CalibrationError&) {
    // What looked like one, somewhere in a scene, was none.
    if (flags.board != "auto" || !flags.square.empty()) throw;
    return without_board(calibration, pictures);
  }
}

int run(const Flags& flags) {
  const Calibration calibration = read_calibration(flags.calibration);
  const std::vector<ImagePair> pictures = pairs_of(flags);
  const Size size = pictures.front().left.size();
  if (size != calibration.image) {
    throw CalibrationError("the images are " + to_string(size) + ", the calibration is for " +
                           to_string(calibration.image) +
                           "; take images of that size, or calibrate at this one");
  }
  const Measured measured = measure(flags, calibration, pictures);

  Grade grade = grade_of_epipolar_error(measured.epipolar_error_px);
  std::printf("row error: %.2f px (%s)\n", measured.epipolar_error_px, measured.how.c_str());
  if (measured.scale_known) {
    std::printf("lengths measured come out %.2f %% too %s\n", 100 * std::abs(measured.scale_error),
                measured.scale_error < 0 ? "short" : "long");
    if (std::abs(measured.scale_error) > 0.02) grade = Grade::kDoAgain;
  }
  std::string depth;
  for (const double z : kReportedDepths_m) {
    const DepthErrorSources sources{measured.epipolar_error_px, std::abs(measured.scale_error)};
    depth += (depth.empty() ? "" : ", ") + length_in_words(expected_depth_error_m(calibration, sources, z)) +
             " at " + fixed(z, z < 1 ? 1 : 0) + " m";
  }
  std::printf("what it means for depth, if disparities are off by as much as rows: by %s\n", depth.c_str());
  std::printf("verdict: %s\n", grade == Grade::kGood ? "good; no need to calibrate again"
                               : grade == Grade::kUsable
                                   ? "usable; calibrate again when there is time"
                                   : "calibrate again: the matcher loses points, and depth "
                                     "is wrong");
  return grade == Grade::kDoAgain ? kExitBadResult : kExitGood;
}

}  // namespace

void add_check_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "check", "is a calibration still right? on new images or live ones, with a board or without");
  auto flags = std::make_shared<Flags>();
  command->add_option("CALIBRATION", flags->calibration, "calibration.yaml")->required();
  command->add_option("FOLDER", flags->input.directory, "pairs, as for solve");
  command->add_option("--left", flags->input.left, "the left camera's images, in order");
  command->add_option("--right", flags->input.right, "the right camera's images, in the same order");
  command->add_option("--side-by-side", flags->input.side_by_side, "images with both halves");
  add_feed_options(*command, flags->feed);
  command->add_option("--pairs", flags->pairs, "live: how many pairs to look at")
      ->check(CLI::Range(1, 200))
      ->capture_default_str();
  command->add_option("--board", flags->board, "inner corners like 9x6, none for any scene, or auto")
      ->capture_default_str();
  command->add_option("--square", flags->square, "side of a square with its unit: checks lengths as well");
  command->callback([flags, &status] { status = run(*flags); });
}

}  // namespace stereod
