#include "calib/board/board_search.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <thread>

#include "calib/base/errors.h"
#include "calib/board/corner_order.h"
#include "calib/solve/pair_consensus.h"
#include "daemon/base/progress.h"

namespace stereod {

namespace {

// How many images are looked at to find out which board it is.
constexpr std::size_t kSamples = 6;

// Calls work(i) for i < count on all CPUs.
template <typename Work>
void in_parallel(std::size_t count, Work&& work) {
  std::atomic<std::size_t> next{0};
  std::vector<std::jthread> threads;
  const std::size_t most = std::max(1U, std::thread::hardware_concurrency());
  for (std::size_t t = 0; t < std::min(most, count); ++t) {
    threads.emplace_back([&] {
      for (std::size_t i = next++; i < count; i = next++) work(i);
    });
  }
}

std::vector<std::size_t> sampled(const std::vector<ImagePair>& pictures) {
  return evenly_spread(std::min(kSamples, pictures.size()), pictures.size());
}

// In how many of the sampled images the whole board is found.
int times_seen(const std::vector<ImagePair>& pictures, const Board& board) {
  const auto places = sampled(pictures);
  std::atomic<int> seen{0};
  in_parallel(2 * places.size(), [&](std::size_t i) {
    const ImagePair& pair = pictures[places[i / 2]];
    if (find_board((i % 2 == 0 ? pair.left : pair.right).view(), board, Effort::kThorough)) ++seen;
  });
  return seen;
}

// Seen in fewer of the images that show a board, it is not their board: its edge may pass for a further
// column, and in a blurred image anything for a small board.
constexpr int kOneInSoMany = 3;

struct SeenBoard {
  Board board;
  int times;  ///< times_seen()
};

// The board that the sampled images show, if any.
std::optional<SeenBoard> board_in(const std::vector<ImagePair>& pictures) {
  std::map<std::pair<int, int>, int> votes;
  std::mutex mutex;
  const auto places = sampled(pictures);
  Progress progress("which board is it?", 2 * places.size());
  in_parallel(2 * places.size(), [&](std::size_t i) {
    const ImagePair& pair = pictures[places[i / 2]];
    const auto found = find_any_board((i % 2 == 0 ? pair.left : pair.right).view());
    const std::lock_guard lock(mutex);
    if (found) ++votes[{found->columns, found->rows}];
    progress.step();
  });
  // The largest one, for often only a part of a board is found, that is found often enough when it is looked
  // for; first of those that were come upon more than once.
  std::vector<std::pair<std::pair<int, int>, int>> candidates(votes.begin(), votes.end());
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    return std::pair(a.second > 1, a.first.first * a.first.second) >
           std::pair(b.second > 1, b.first.first * b.first.second);
  });
  int showing = 0;
  for (const auto& [size, count] : candidates) showing += count;
  for (const auto& [size, count] : candidates) {
    const Board board{size.first, size.second, 0};
    const int times = times_seen(pictures, board);
    if (kOneInSoMany * times >= showing) return SeenBoard{board, times};
  }
  return std::nullopt;
}

PairSearch search(const ImagePair& pair, const Board& board) {
  PairSearch result;
  if (same_pixels(pair.left, pair.right)) {
    result.problem = "left and right are the same image";
    return result;
  }
  const auto left = find_board(pair.left.view(), board, Effort::kThorough);
  const auto right = find_board(pair.right.view(), board, Effort::kThorough);
  if (left) result.corners.left = left->corners, result.left_edge_px = left->edge_width_px;
  if (right) result.corners.right = right->corners, result.right_edge_px = right->edge_width_px;
  if (!left && !right) {
    result.problem = "no whole board found in either image";
  } else if (!left || !right) {
    result.problem = std::string("no whole board found in the ") + (left ? "right" : "left") + " image";
  } else if (const auto turned = turned_like(left->corners, board, right->corners)) {
    result.corners.right = *turned;
  } else {
    result.problem =
        "which end of the board is which cannot be told: it is turned differently in the two images, and "
        "this board looks the same from several sides";
  }
  return result;
}

bool same_size(const Board& a, const Board& b) {
  return std::minmax(a.columns, a.rows) == std::minmax(b.columns, b.rows);
}

// Before the long search: is it this board? It is also found where the images show a larger one, less its
// edge, and so, about as often as that; where they seem to show a smaller one, it may be partly hidden in
// just these.
void require_size(const std::vector<ImagePair>& pictures, const Board& board) {
  const auto seen = board_in(pictures);
  if (!seen || same_size(seen->board, board)) return;
  const Board& there = seen->board;
  // Seen in less than half of the images, of which each pair has two, it says little against a person's
  // word.
  if (seen->times < static_cast<int>(sampled(pictures).size())) return;
  const int this_one = times_seen(pictures, board);
  const bool is_larger = there.columns * there.rows > board.columns * board.rows;
  if (is_larger ? this_one > 2 * seen->times : this_one > 0) return;
  throw CalibrationError("the images show a board of " + in_words(there) + ", not " + in_words(board) +
                         "; say --board " + std::to_string(there.columns) + "x" + std::to_string(there.rows) +
                         " (inner corners are those where four squares meet)");
}

}  // namespace

Board guess_board(const std::vector<ImagePair>& pictures) {
  if (const auto seen = board_in(pictures)) return seen->board;
  throw CalibrationError(
      "no chessboard was found in the images; the whole board with its white border must be seen, flat, "
      "sharp and evenly lit");
}

std::vector<PairSearch> search_boards(const std::vector<ImagePair>& pictures, const Board& board) {
  require_size(pictures, board);
  std::vector<PairSearch> results(pictures.size());
  {
    std::mutex mutex;
    Progress progress("looking for the board", pictures.size());
    in_parallel(pictures.size(), [&](std::size_t i) {
      results[i] = search(pictures[i], board);
      const std::lock_guard lock(mutex);
      progress.step();
    });
  }
  const bool found = std::any_of(results.begin(), results.end(), [](const PairSearch& r) {
    return !r.corners.left.empty() || !r.corners.right.empty();
  });
  if (!found) {
    throw CalibrationError("no board with " + in_words(board) +
                           " was found in any image; the whole board with its white border must be seen, "
                           "flat, sharp and evenly lit");
  }
  return results;
}

}  // namespace stereod
