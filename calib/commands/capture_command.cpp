// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>

#include "calib/base/errors.h"
#include "calib/board/board_finder.h"
#include "calib/board/corner_order.h"
#include "calib/commands/commands.h"
#include "calib/commands/feed_options.h"
#include "calib/commands/solve_command.h"
#include "calib/live/capture_guide.h"
#include "calib/live/live_page.h"
#include "calib/live/live_state.h"
#include "daemon/base/file.h"
#include "daemon/base/file_error.h"
#include "daemon/imagefile/write_image.h"

namespace stereod::calib {

namespace {

namespace fs = std::filesystem;

struct Flags {
  FeedFlags feed;
  fs::path keep;
  BoardFlags board;
  SolveOutput output;
  int pairs = 15, port = 8090;
};

volatile std::sig_atomic_t interrupted = 0;
extern "C" void on_interrupt(int) { interrupted = 1; }

// The status on stderr: one updated line on a terminal, otherwise a new line for each new instruction.
class StatusLine {
 public:
  void show(const LiveSnapshot& snapshot) {
    if (terminal_) {
      std::fprintf(stderr, "\r\033[K%s", status_line(snapshot).c_str());
    } else if (snapshot.words != last_) {
      std::fprintf(stderr, "%s\n", status_line(snapshot).c_str());
    }
    last_ = snapshot.words;
  }
  void taken() const {
    if (terminal_) std::fputs("\a", stderr);
  }
  void end() const {
    if (terminal_) std::fputs("\n", stderr);
  }

 private:
  bool terminal_ = ::isatty(STDERR_FILENO) == 1;
  std::string last_;
};

// Finds the board in both images, one thread each.
BoardPair find_in_both(const ImagePair& pair, const Board& board) {
  auto right =
      std::async(std::launch::async, [&] { return find_board(pair.right.view(), board, Effort::kLive); });
  const auto left = find_board(pair.left.view(), board, Effort::kLive);
  const auto found_right = right.get();
  BoardPair corners;
  if (left) corners.left = left->corners;
  if (found_right) corners.right = found_right->corners;
  if (left && found_right) {
    // A board of ambiguous orientation counts as not found.
    corners.right = turned_like(corners.left, board, corners.right).value_or(Corners{});
  }
  return corners;
}

void write_pair(const fs::path& directory, std::size_t number, const ImagePair& pair) {
  if (directory.empty()) return;
  const std::string name = (number < 10 ? "0" : "") + std::to_string(number) + ".png";
  write_png(directory / ("left_" + name), pair.left.view());
  write_png(directory / ("right_" + name), pair.right.view());
}

LiveSnapshot waiting_snapshot(const Flags& flags, const std::vector<ImagePair>& taken) {
  LiveSnapshot snapshot;
  snapshot.words = flags.feed.waiting_message();
  snapshot.taken = static_cast<int>(taken.size());
  snapshot.wanted = flags.pairs;
  return snapshot;
}

std::vector<ImagePair> collect(const Flags& flags, const Board& board, FrameFeed& feed, LivePage* page) {
  constexpr std::chrono::milliseconds kPatience{2000};
  std::optional<CaptureGuide> guide;  // made when the first pair gives the image size
  Size size;
  StatusLine line;
  std::vector<ImagePair> taken;
  while (interrupted == 0 && !feed.finished()) {
    std::optional<ImagePair> pair = feed.next(kPatience);
    if (!pair) {
      if (!feed.finished()) line.show(waiting_snapshot(flags, taken));
      continue;
    }
    if (!guide) size = pair->left.size(), guide.emplace(board, size, flags.pairs);
    if (pair->left.size() != size) {
      throw CalibrationError("the image size changed during the capture; start again");
    }
    const BoardPair corners = find_in_both(*pair, board);
    const CaptureGuide::Instruction instruction = guide->observe(corners.left, corners.right);
    const LiveSnapshot snapshot = snapshot_of(*guide, instruction, corners.left, corners.right, size);
    line.show(snapshot);
    if (page != nullptr) page->show(snapshot, pair->left.view(), pair->right.view());
    if (instruction.take) {
      line.taken();
      write_pair(flags.keep, taken.size(), *pair);
      taken.push_back(std::move(*pair));
      taken.back().name = "pair " + std::to_string(taken.size());
    }
    if (instruction.complete) break;
  }
  line.end();
  return taken;
}

// Throws before the capture if a file could not be written after it.
void check_outputs(const Flags& flags) {
  require_writable(flags.output.calibration);
  require_distinct({flags.output.calibration, flags.output.report}, {flags.feed.config});
  if (!flags.output.report.empty()) require_writable(flags.output.report);
  if (flags.keep.empty()) return;
  std::error_code error;
  fs::create_directories(flags.keep, error);
  if (!fs::is_empty(flags.keep, error) && !error) {
    throw FileError(
        flags.keep.string() +
        ": the directory is not empty; give a new or empty directory, so that old and new images do not mix");
  }
  require_writable(flags.keep / "left_00.png");
}

int run(const Flags& flags) {
  const SolveOptions options = solve_options(flags.board);
  if (!options.board) {
    throw UsageError(
        "--board: found 'auto', allowed are inner corners across and down, like 9x6; detecting the board is too "
        "slow for live capture");
  }
  check_outputs(flags);
  const std::unique_ptr<FrameFeed> feed = open_feed(flags.feed);
  std::unique_ptr<LivePage> page;
  if (flags.port > 0) {
    page = std::make_unique<LivePage>(flags.port);
    std::fprintf(stderr,
                 "Live images: http://127.0.0.1:%d/ (from another machine: ssh -L %d:127.0.0.1:%d ROBOT)\n",
                 page->port(), page->port(), page->port());
  }
  std::fputs(
      "Pairs are taken automatically while the board is still. Ctrl-C ends the capture and calibrates.\n",
      stderr);
  std::signal(SIGINT, on_interrupt);
  const std::vector<ImagePair> images = collect(flags, *options.board, *feed, page.get());
  std::signal(SIGINT, SIG_DFL);
  std::printf("%zu pairs taken\n", images.size());
  return solve_and_write(images, options, flags.output);
}

}  // namespace

void add_capture_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "capture", "calibrate live: guide you while you move the board in front of the cameras, then solve");
  auto flags = std::make_shared<Flags>();
  flags->board.board = "9x6";
  add_feed_options(*command, flags->feed);
  command
      ->add_option("--board", flags->board.board, "inner corners (where four squares meet) across and down")
      ->capture_default_str();
  command
      ->add_option("--square", flags->board.square,
                   "side of a square as measured on the print, with unit: 25mm")
      ->required();
  command->add_option("--lens", flags->board.lens, "lens model: " + std::string(kLensChoices))
      ->capture_default_str();
  command
      ->add_option("--pairs", flags->pairs,
                   "pairs to take; up to twice as many until the board has covered the image")
      ->check(CLI::Range(kMinPairs, 200))
      ->capture_default_str();
  command->add_option("--port", flags->port, "port of the live page on 127.0.0.1; 0: no page")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command->add_option("--keep", flags->keep, "directory to save the taken pairs in, for solve");
  flags->output.calibration = "calibration.yaml";
  command->add_option("-o,--output", flags->output.calibration, "calibration file for stereod")
      ->capture_default_str();
  command->add_option("--report", flags->output.report, "report about the result, one HTML file");
  command->callback([flags, &status] { status = run(*flags); });
}

}  // namespace stereod::calib
