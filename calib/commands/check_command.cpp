// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "calib/base/errors.h"
#include "calib/base/pair_input.h"
#include "calib/base/text.h"
#include "calib/board/board_search.h"
#include "calib/commands/commands.h"
#include "calib/commands/feed_options.h"
#include "calib/quality/coverage.h"
#include "calib/quality/depth_error.h"
#include "calib/quality/epipolar_matches.h"
#include "calib/quality/rectified_view.h"
#include "calib/quality/verdict.h"
#include "calib/solve/camera_solver.h"
#include "calib/solve/pair_check.h"
#include "daemon/base/progress.h"
#include "daemon/config/calibration_file.h"

namespace stereod::calib {

namespace {

struct Flags {
  std::filesystem::path calibration;
  PairInput input;
  FeedFlags feed;
  int pairs = 10;
  std::string board = "auto", square;
};

// The board shows that left and right are swapped; distinguishes this from a false detection of a board.
struct SwappedCamerasError : CalibrationError {
  using CalibrationError::CalibrationError;
};

// The errors of the calibration on the given images.
struct Measurement {
  double epipolar_error_px = 0;
  std::string how;         // for the output
  double scale_error = 0;  // 0 if the side of a square is unknown
  bool scale_known = false;
};

Measurement measure_on_board(const Calibration& calibration, const std::vector<ImagePair>& images,
                             Board board, const std::string& square) {
  if (!square.empty()) board.square_m = parse_length(square, "--square");
  const bool sized = board.square_m > 0;
  if (!sized) board.square_m = 0.025;  // the epipolar error does not depend on it
  Measurement result;
  double count = 0, behind = 0;
  for (std::size_t i = 0; const PairSearch& pair : search_boards(images, board)) {
    const std::string& name = images[i++].name;
    if (!pair.problem.empty()) {
      std::printf("%s: %s\n", name.c_str(), pair.problem.c_str());
      continue;
    }
    const BoardPose pose = solve_pose(calibration.left.camera, board, pair.corners.left);
    const PairCheck check = check_pair(calibration, board, pair.corners, pose);
    std::printf("%s: epipolar error %.2f px\n", name.c_str(), check.epipolar_error_px);
    behind += check.behind_share > 0.5 ? 1 : 0;
    result.epipolar_error_px += check.epipolar_error_px;
    result.scale_error += check.scale_error;
    count += 1;
  }
  if (count == 0) throw CalibrationError("no pair shows the complete board in both images");
  if (behind == count) {
    throw SwappedCamerasError(
        "with this calibration the board is behind the cameras in every pair; check that left and right are not "
        "exchanged");
  }
  result.epipolar_error_px /= count;
  result.scale_error /= count;
  result.scale_known = sized;
  result.how = "measured on a board with " + to_string(board) + " in " + fixed(count, 0) + " pairs";
  return result;
}

Measurement measure_on_scene(const Calibration& calibration, const std::vector<ImagePair>& images) {
  std::vector<EpipolarMatch> all;
  {
    Progress progress("matching", images.size());
    for (const ImagePair& pair : images) {
      const auto matches = match_epipolar_points(rectified_view(calibration.left, pair.left.view()).view(),
                                                 rectified_view(calibration.right, pair.right.view()).view());
      all.insert(all.end(), matches.begin(), matches.end());
      progress.step();
    }
  }
  const auto found = epipolar_error(all, calibration.image);
  if (!found) {
    throw CalibrationError(
        "found only " + std::to_string(all.size()) +
        " points in both images of a pair, too few to measure; show a scene with texture or a board. If the scene has "
        "texture, the calibration is wrong by many pixels");
  }
  Measurement result;
  result.epipolar_error_px = found->epipolar_error_px;
  result.how = "measured on " + std::to_string(found->points) + " points of " +
               std::to_string(images.size()) + " pairs; worst in " + image_part_name(found->worst_part) +
               ", " + fixed(found->worst_px, 2) + " px";
  return result;
}

// Takes flags.pairs consecutive live pairs; fewer only if a recording ends.
std::vector<ImagePair> live_pairs(const Flags& flags) {
  constexpr std::chrono::seconds kPatience{15};
  const std::unique_ptr<FrameFeed> feed = open_feed(flags.feed);
  std::vector<ImagePair> images;
  Progress progress("taking pairs", static_cast<std::size_t>(flags.pairs));
  while (static_cast<int>(images.size()) < flags.pairs && !feed->finished()) {
    std::optional<ImagePair> pair = feed->next(kPatience);
    if (!pair) {
      if (feed->finished()) break;
      throw CalibrationError("no image pair arrived within " + std::to_string(kPatience.count()) + " s (" +
                             flags.feed.waiting_message() + ")");
    }
    if (!images.empty() && pair->left.size() != images.front().left.size()) {
      throw CalibrationError("the image size changed; start again");
    }
    images.push_back(std::move(*pair));
    progress.step();
  }
  if (images.empty()) throw CalibrationError("the recording contains no image pair");
  return images;
}

std::vector<ImagePair> pairs_of(const Flags& flags) {
  if (!flags.feed.any()) return read_pairs(flags.input);
  if (!flags.input.directory.empty() || !flags.input.left.empty() || !flags.input.right.empty() ||
      !flags.input.side_by_side.empty()) {
    throw UsageError("give image files, or --daemon or --config for live images, not both");
  }
  return live_pairs(flags);
}

std::optional<Board> board_for(const Flags& flags, const std::vector<ImagePair>& images) {
  if (flags.board == "none") return std::nullopt;
  if (flags.board != "auto") return parse_board(flags.board);
  try {
    return guess_board(images);
  } catch (const CalibrationError&) {
    return std::nullopt;
  }
}

Measurement measure(const Flags& flags, const Calibration& calibration,
                    const std::vector<ImagePair>& images) {
  const auto board = board_for(flags, images);
  if (!board) return measure_on_scene(calibration, images);
  try {
    return measure_on_board(calibration, images, *board, flags.square);
  } catch (const SwappedCamerasError&) {
    throw;
  } catch (const CalibrationError&) {
    // The detected board was a false detection in a scene without one.
    if (flags.board != "auto" || !flags.square.empty()) throw;
    return measure_on_scene(calibration, images);
  }
}

int run(const Flags& flags) {
  const Calibration calibration = read_calibration(flags.calibration);
  const std::vector<ImagePair> images = pairs_of(flags);
  const Size size = images.front().left.size();
  if (size != calibration.image) {
    throw CalibrationError("image size is " + std::to_string(size.width) + "×" + std::to_string(size.height) +
                           " px, but the calibration is for " + std::to_string(calibration.image.width) +
                           "×" + std::to_string(calibration.image.height) +
                           " px; take images of that size, or calibrate again at this size");
  }
  const Measurement measured = measure(flags, calibration, images);

  Grade grade = grade_of_epipolar_error(measured.epipolar_error_px);
  std::printf("epipolar error: %.2f px (%s)\n", measured.epipolar_error_px, measured.how.c_str());
  if (measured.scale_known) {
    std::printf("scale error: measured lengths are %.2f %% too %s\n", 100 * std::abs(measured.scale_error),
                measured.scale_error < 0 ? "short" : "long");
    if (std::abs(measured.scale_error) > 0.02) grade = Grade::kDoAgain;
  }
  std::string depth;
  for (const double z : kReportedDepths_m) {
    const DepthErrorSources sources{measured.epipolar_error_px, std::abs(measured.scale_error)};
    depth += (depth.empty() ? "" : ", ") + format_length(expected_depth_error_m(calibration, sources, z)) +
             " at " + fixed(z, z < 1 ? 1 : 0) + " m";
  }
  std::printf("expected depth error, if disparity errors equal the epipolar error: %s\n", depth.c_str());
  std::printf("verdict: %s\n", grade == Grade::kGood     ? "good; no need to calibrate again"
                               : grade == Grade::kUsable ? "usable; calibrate again when there is time"
                                                         : "calibrate again: the matcher loses points and "
                                                           "depth is wrong");
  return grade == Grade::kDoAgain ? kExitBadResult : kExitGood;
}

}  // namespace

void add_check_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "check", "check whether a calibration is still valid, on new or live images, with or without a board");
  auto flags = std::make_shared<Flags>();
  command->add_option("CALIBRATION", flags->calibration, "calibration file")->required();
  command->add_option("DIRECTORY", flags->input.directory, "image pairs, as for solve");
  command->add_option("--left", flags->input.left, "images of the left camera, in order");
  command->add_option("--right", flags->input.right, "images of the right camera, in the same order");
  command->add_option("--side-by-side", flags->input.side_by_side,
                      "images that contain the left and the right image side by side");
  add_feed_options(*command, flags->feed);
  command->add_option("--pairs", flags->pairs, "live images: number of pairs to check")
      ->check(CLI::Range(1, 200))
      ->capture_default_str();
  command
      ->add_option("--board", flags->board,
                   "inner corners like 9x6; none: any scene without a board; auto: detect")
      ->capture_default_str();
  command->add_option("--square", flags->square, "side of a square, with unit: also checks the scale");
  command->callback([flags, &status] { status = run(*flags); });
}

}  // namespace stereod::calib
