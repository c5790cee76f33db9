#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <future>
#include <memory>

#include "calib/board_finder.h"
#include "calib/commands.h"
#include "calib/corner_order.h"
#include "calib/errors.h"
#include "calib/feed_options.h"
#include "calib/guidance.h"
#include "calib/live_page.h"
#include "calib/live_state.h"
#include "calib/solve_command.h"
#include "daemon/config/file_error.h"
#include "daemon/config/text_file.h"
#include "daemon/imagefile/write_image.h"

namespace stereod {

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

// One line that changes, on a terminal; elsewhere a new line for each new advice.
class StatusLine {
 public:
  void show(const LiveMoment& moment) {
    if (terminal_) {
      std::fprintf(stderr, "\r\033[K%s", status_line(moment).c_str());
    } else if (moment.words != last_) {
      std::fprintf(stderr, "%s\n", status_line(moment).c_str());
    }
    last_ = moment.words;
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

// The board in both pictures at once.
BoardPair look(const PicturePair& pair, const Board& board) {
  auto right =
      std::async(std::launch::async, [&] { return find_board(pair.right.view(), board, Effort::kLive); });
  const auto left = find_board(pair.left.view(), board, Effort::kLive);
  const auto other = right.get();
  BoardPair corners;
  if (left) corners.left = left->corners;
  if (other) corners.right = other->corners;
  if (left && other) {
    // What cannot be told apart counts as not seen.
    corners.right = turned_like(corners.left, board, corners.right).value_or(Corners{});
  }
  return corners;
}

void write_pair(const fs::path& folder, std::size_t number, const PicturePair& pair) {
  if (folder.empty()) return;
  const std::string name = (number < 10 ? "0" : "") + std::to_string(number) + ".png";
  write_png(folder / ("left_" + name), pair.left.view());
  write_png(folder / ("right_" + name), pair.right.view());
}

LiveMoment waiting_moment(const Flags& flags, const std::vector<PicturePair>& taken) {
  LiveMoment moment;
  moment.words = flags.feed.waiting_words();
  moment.taken = static_cast<int>(taken.size());
  moment.wanted = flags.pairs;
  return moment;
}

std::vector<PicturePair> collect(const Flags& flags, const Board& board, FrameFeed& feed, LivePage* page) {
  constexpr std::chrono::milliseconds kPatience{2000};
  std::optional<Guide> guide;  // once it is known how large the pictures are
  Size size;
  StatusLine line;
  std::vector<PicturePair> taken;
  while (interrupted == 0 && !feed.finished()) {
    std::optional<PicturePair> pair = feed.next(kPatience);
    if (!pair) {
      if (!feed.finished()) line.show(waiting_moment(flags, taken));
      continue;
    }
    if (!guide) size = pair->left.size(), guide.emplace(board, size, flags.pairs);
    if (pair->left.size() != size) {
      throw CalibrationError("the pictures changed their size while calibrating; begin again");
    }
    const BoardPair corners = look(*pair, board);
    const Guide::Advice advice = guide->observe(corners.left, corners.right);
    const LiveMoment moment = moment_of(*guide, advice, corners.left, corners.right, size);
    line.show(moment);
    if (page != nullptr) page->show(moment, pair->left.view(), pair->right.view());
    if (advice.take) {
      line.taken();
      write_pair(flags.keep, taken.size(), *pair);
      taken.push_back(std::move(*pair));
      taken.back().name = "pair " + std::to_string(taken.size());
    }
    if (advice.complete) break;
  }
  line.end();
  return taken;
}

int run(const Flags& flags) {
  const SolveOptions options = solve_options(flags.board);
  if (!options.board) {
    throw UsageError("--board: say which board it is, like 9x6; 'auto' would be too slow to guide you live");
  }
  require_writable(flags.output.calibration);
  require_distinct({flags.output.calibration, flags.output.report}, {flags.feed.config});
  if (!flags.output.report.empty()) require_writable(flags.output.report);
  if (!flags.keep.empty()) {
    std::error_code error;
    fs::create_directories(flags.keep, error);
    if (!fs::is_empty(flags.keep, error) && !error) {
      throw FileError(
          flags.keep.string() +
          ": the folder is not empty, and its pictures would be mixed with the new ones; name a new one");
    }
    require_writable(flags.keep / "left_00.png");
  }
  const std::unique_ptr<FrameFeed> feed = open_feed(flags.feed);
  std::unique_ptr<LivePage> page;
  if (flags.port > 0) {
    page = std::make_unique<LivePage>(flags.port);
    std::fprintf(stderr,
                 "Live pictures: http://127.0.0.1:%d/ (from another machine: ssh -L %d:127.0.0.1:%d ROBOT)\n",
                 page->port(), page->port(), page->port());
  }
  std::fputs(
      "Pairs are taken by themselves while the board is held still. Ctrl-C ends taking and calibrates.\n",
      stderr);
  std::signal(SIGINT, on_interrupt);
  const std::vector<PicturePair> pictures = collect(flags, *options.board, *feed, page.get());
  std::signal(SIGINT, SIG_DFL);
  std::printf("%zu pairs taken\n", pictures.size());
  return solve_and_write(pictures, options, flags.output);
}

}  // namespace

void add_capture_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "capture", "calibrate live: guides you while you move the board before the cameras, then solves");
  auto flags = std::make_shared<Flags>();
  flags->board.board = "9x6";
  add_feed_options(*command, flags->feed);
  command->add_option("--board", flags->board.board, "inner corners across and down")->capture_default_str();
  command
      ->add_option("--square", flags->board.square,
                   "side of a square as measured on the print, with its unit: 25mm")
      ->required();
  command->add_option("--lens", flags->board.lens, "lens model: " + std::string(kLensChoices))
      ->capture_default_str();
  command->add_option("--pairs", flags->pairs, "pairs to take, more if parts of the image stay empty")
      ->check(CLI::Range(kFewestPairs, 200))
      ->capture_default_str();
  command->add_option("--port", flags->port, "of the live page on 127.0.0.1; 0: no page")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command->add_option("--keep", flags->keep, "a folder to keep the taken pairs in, for solve");
  flags->output.calibration = "calibration.yaml";
  command->add_option("-o,--output", flags->output.calibration, "the calibration, as stereod reads it")
      ->capture_default_str();
  command->add_option("--report", flags->output.report, "a page about the result, one .html file");
  command->callback([flags, &status] { status = run(*flags); });
}

}  // namespace stereod
