// SPDX-License-Identifier: BSD-3-Clause
#include "calib/board/board_search.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <thread>

#include "calib/base/errors.h"
#include "calib/base/statistics.h"
#include "calib/board/board_finder.h"
#include "calib/board/corner_order.h"
#include "daemon/base/progress.h"

namespace stereod::calib {

namespace {

// Pairs that are searched to find out which board the images show.
constexpr std::size_t kSampledPairs = 6;

// Calls work(i) for each i < count, using all CPUs.
template <typename Work>
void in_parallel(std::size_t count, Work&& work) {
  std::atomic<std::size_t> next{0};
  std::vector<std::jthread> threads;
  const std::size_t cpus = std::max(1U, std::thread::hardware_concurrency());
  for (std::size_t t = 0; t < std::min(cpus, count); ++t) {
    threads.emplace_back([&] {
      for (std::size_t i = next++; i < count; i = next++) work(i);
    });
  }
}

std::vector<std::size_t> sampled(const std::vector<ImagePair>& images) {
  return evenly_spaced(std::min(kSampledPairs, images.size()), images.size());
}

// Returns in how many of the sampled images the whole board is found.
int count_images_showing(const std::vector<ImagePair>& images, const Board& board) {
  const auto places = sampled(images);
  std::atomic<int> seen{0};
  in_parallel(2 * places.size(), [&](std::size_t i) {
    const ImagePair& pair = images[places[i / 2]];
    if (find_board((i % 2 == 0 ? pair.left : pair.right).view(), board, Effort::kThorough)) ++seen;
  });
  return seen;
}

// A board found in less than a third of the images that show any board is a false detection: the board's edge
// may be taken for a further column, and a pattern in a blurred image for a small board.
constexpr int kMinShareDivisor = 3;

struct SampledBoard {
  Board board;
  int images;  ///< count_images_showing()
};

// Returns the board that the sampled images show.
std::optional<SampledBoard> board_in_sample(const std::vector<ImagePair>& images) {
  std::map<std::pair<int, int>, int> votes;
  std::mutex mutex;
  const auto places = sampled(images);
  Progress progress("identifying the board", 2 * places.size());
  in_parallel(2 * places.size(), [&](std::size_t i) {
    const ImagePair& pair = images[places[i / 2]];
    const auto found = find_any_board((i % 2 == 0 ? pair.left : pair.right).view());
    const std::lock_guard lock(mutex);
    if (found) ++votes[{found->columns, found->rows}];
    progress.step();
  });
  // Often only a part of a board is found, so larger candidates come first, and before all those found once the
  // candidates found several times. The first candidate that a direct search confirms is the board.
  std::vector<std::pair<std::pair<int, int>, int>> candidates(votes.begin(), votes.end());
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    return std::pair(a.second > 1, a.first.first * a.first.second) >
           std::pair(b.second > 1, b.first.first * b.first.second);
  });
  int showing = 0;
  for (const auto& [size, count] : candidates) showing += count;
  for (const auto& [size, count] : candidates) {
    const Board board{size.first, size.second, 0};
    const int times = count_images_showing(images, board);
    if (kMinShareDivisor * times >= showing) return SampledBoard{board, times};
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
    result.problem = "no complete board found in either image";
  } else if (!left || !right) {
    result.problem = std::string("no complete board found in the ") + (left ? "right" : "left") + " image";
  } else if (const auto turned = turned_like(left->corners, board, right->corners)) {
    result.corners.right = *turned;
  } else {
    result.problem =
        "the board's orientation is ambiguous: it appears turned differently in the two images, and this board "
        "looks the same after half a turn";
  }
  return result;
}

bool same_size(const Board& a, const Board& b) {
  return std::minmax(a.columns, a.rows) == std::minmax(b.columns, b.rows);
}

// Throws if the sampled images show a board of another size than the named one; run before the long search.
// The named board is also found within a larger one, about as often as the larger one itself. A smaller board may
// be the named one, partly hidden in the sample.
void require_size(const std::vector<ImagePair>& images, const Board& board) {
  const auto seen = board_in_sample(images);
  if (!seen || same_size(seen->board, board)) return;
  const Board& there = seen->board;
  // A board found in less than half of the sampled images (two per pair) does not overrule the user.
  if (seen->images < static_cast<int>(sampled(images).size())) return;
  const int named = count_images_showing(images, board);
  const bool is_larger = there.columns * there.rows > board.columns * board.rows;
  if (is_larger ? named > 2 * seen->images : named > 0) return;
  throw CalibrationError("the images show a board with " + to_string(there) + ", not " + to_string(board) +
                         "; use --board " + std::to_string(there.columns) + "x" + std::to_string(there.rows) +
                         " (an inner corner is where four squares meet)");
}

}  // namespace

Board guess_board(const std::vector<ImagePair>& images) {
  if (const auto seen = board_in_sample(images)) return seen->board;
  throw CalibrationError(
      "no chessboard found in the images; show the complete board with its white border, flat, sharp and evenly "
      "lit");
}

std::vector<PairSearch> search_boards(const std::vector<ImagePair>& images, const Board& board) {
  require_size(images, board);
  std::vector<PairSearch> results(images.size());
  {
    std::mutex mutex;
    Progress progress("searching the board", images.size());
    in_parallel(images.size(), [&](std::size_t i) {
      results[i] = search(images[i], board);
      const std::lock_guard lock(mutex);
      progress.step();
    });
  }
  const bool found = std::any_of(results.begin(), results.end(), [](const PairSearch& r) {
    return !r.corners.left.empty() || !r.corners.right.empty();
  });
  if (!found) {
    throw CalibrationError(
        "no board with " + to_string(board) +
        " found in any image; show the complete board with its white border, flat, sharp and "
        "evenly lit");
  }
  return results;
}

}  // namespace stereod::calib
