// SPDX-License-Identifier: BSD-3-Clause
// The thesis' tables of matching.
#include <algorithm>
#include <iostream>
#include <limits>
#include <memory>
#include <opencv2/calib3d.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/cpu.h"
#include "core/match/frame_matcher.h"
#include "tests/bench/bench_images.h"
#include "tests/bench/bench_thesis.h"
#include "tests/bench/interleaved.h"
#include "tests/bench/tables.h"

namespace stereod::bench {
namespace {

constexpr int kNaiveTurns = 4;
constexpr const char* kOpenCv = "OpenCV BM";
constexpr const char* kConditions =
    R"(Own: raw gray values, whole pixels, no test, no filter, as in the thesis. OpenCV's StereoBM: texture,
uniqueness, left-right and speckle tests off. The thesis switched its prefilter off too; there is no such
setting, so OpenCV works on (and takes the time for) its XSobel image here. It also leaves the left 64
columns empty and always answers in 1/16 px. Like for like with it are the xsobel columns of the last table.
)";

/// Returns the options of the thesis' matcher: raw sums of absolute differences, 11×11, 64 disparities, no
/// filter.
MatcherOptions thesis_options(Implementation implementation, Isa isa = Isa::kAuto) {
  MatcherOptions options = matcher_preset("thesis").value();
  options.implementation = implementation;
  options.isa = isa;
  return options;
}

/// A matcher with its threads and the memory for its disparities.
class OwnMatcher {
 public:
  OwnMatcher(const MatcherOptions& options, const MatPair& pair, int workers)
      : pair_(pair),
        pool_(workers),
        matcher_(options, view_of(pair.left).size(), pool_),
        answer_(view_of(pair.left).size()) {}

  void match() { matcher_.match(view_of(pair_.left), view_of(pair_.right), answer_.view()); }

  bool same_answer(OwnMatcher& other) {
    match();
    other.match();
    for (int y = 0; y < answer_.height(); ++y) {
      if (!std::equal(answer_.row(y), answer_.row(y) + answer_.width(), other.answer_.row(y))) return false;
    }
    return true;
  }

 private:
  MatPair pair_;
  WorkerPool pool_;
  FrameMatcher matcher_;
  DisparityImage answer_;
};

class MatchingContest {
 public:
  explicit MatchingContest(const MatPair& pair) : pair_(pair) {
    const cv::Ptr<cv::StereoBM> bm = cv::StereoBM::create(64, 11);
    bm->setTextureThreshold(0);
    bm->setUniquenessRatio(0);
    bm->setSpeckleWindowSize(0);
    bm->setDisp12MaxDiff(-1);
    const auto out = std::make_shared<cv::Mat>();
    run_.add(kOpenCv, [bm, out, pair] { bm->compute(pair.left, pair.right, *out); });
  }

  OwnMatcher& add(const std::string& name, const MatcherOptions& options, int workers = 1,
                  int at_most = std::numeric_limits<int>::max()) {
    matchers_.push_back(std::make_unique<OwnMatcher>(options, pair_, workers));
    OwnMatcher& matcher = *matchers_.back();
    run_.add(
        name, [&matcher] { matcher.match(); }, at_most);
    return matcher;
  }

  InterleavedResults run(int rounds) const { return run_.run(rounds); }

 private:
  MatPair pair_;
  std::vector<std::unique_ptr<OwnMatcher>> matchers_;
  InterleavedRun run_;
};

std::string workers_name(int workers) { return workers == 1 ? "SIMD" : std::to_string(workers) + " workers"; }

void print_matching_tables(const InterleavedResults& results, const Cells& by_workers) {
  const auto faster = [&](const std::string& a, const std::string& b) {
    return results.of(a).median < results.of(b).median;
  };
  const std::string threaded = *std::min_element(by_workers.begin() + 1, by_workers.end(), faster);
  const Cells contestants = {kOpenCv, "Naive", "Window", "SIMD", threaded};
  const Cells headings = {kOpenCv, "Naive", "Window", "SIMD", "Best threaded"};
  const std::vector<double> q8200 = {8.75, 1808, 62.05, 20.35, 6.40};
  const std::vector<double> i7_720q = {20.64, 4378, 172.70, 53.22, 14.30};
  struct Table {
    std::string title;
    std::ptrdiff_t columns;
  };
  for (const Table& table :
       {Table{"Table 3.1: Naive Stereo Performance", 2}, Table{"Table 3.2: Windowing Stereo Performance", 3},
        Table{"Table 3.4: SIMD Stereo Performance", 4}, Table{"Table 3.5: Parallel Stereo Performance", 5}}) {
    const auto n = table.columns;
    std::cout << "\n";
    print_row(table.title, {headings.begin(), headings.begin() + n});
    print_measured(results, {contestants.begin(), contestants.begin() + n}, kOpenCv);
    print_thesis("Q8200 2.33 GHz", {q8200.begin(), q8200.begin() + n});
    print_thesis("i7-720Q 1.6 GHz", {i7_720q.begin(), i7_720q.begin() + n});
  }
  std::cout << "  best threaded: here " << threaded << "; thesis 4 threads (Q8200), 16 threads (i7-720Q)\n";
}

}  // namespace

void measure_matching(int rounds) {
  const std::optional<MatPair> tsukuba = load_tsukuba();
  if (!tsukuba) {
    std::cout << "Tables 3.1 to 3.5 skipped: no Tsukuba images in " << datasets()
              << "; set STEREO_DATASETS to where they are.\n";
    return;
  }
  std::cout << "Tsukuba " << tsukuba->left.cols << "x" << tsukuba->left.rows
            << ", 64 disparities, 11x11, one thread where nothing else is said.\n"
            << kConditions;

  MatchingContest contest(*tsukuba);
  OwnMatcher& naive = contest.add("Naive", thesis_options(Implementation::kNaive), 1, kNaiveTurns);
  OwnMatcher& window = contest.add("Window", thesis_options(Implementation::kSliding));
  Cells by_workers;
  OwnMatcher* simd = nullptr;
  for (const int workers : {1, 2, 4, 8, 16}) {
    by_workers.push_back(workers_name(workers));
    simd = &contest.add(by_workers.back(), thesis_options(Implementation::kSimd), workers);
  }
  Cells by_isa;
  for (const Isa isa : available_isas()) {
    by_isa.emplace_back(name_of(isa));
    contest.add(by_isa.back(), thesis_options(Implementation::kSimd, isa));
  }
  MatcherOptions filtered = thesis_options(Implementation::kSimd);
  filtered.prefilter = Prefilter::kXsobel;
  contest.add("xsobel", filtered);
  filtered.subpixel = true;
  contest.add("xsobel, 1/16 px", filtered);
  const bool has_sse41 = std::count(by_isa.begin(), by_isa.end(), "sse41") > 0;
  filtered.isa = Isa::kSse41;
  if (has_sse41) contest.add("same, sse41", filtered);

  if (!window.same_answer(naive) || !simd->same_answer(naive)) {
    throw std::runtime_error("the implementations do not give the same answer; their times mean nothing");
  }
  const InterleavedResults results = contest.run(rounds);
  print_matching_tables(results, by_workers);

  std::cout << "\n";
  print_row("Figure 3.13: by workers", by_workers);
  print_measured(results, by_workers, "SIMD");
  std::cout << "\n";
  print_row("Table 3.3: by instruction set", by_isa);  // the thesis lists the instructions there, no times
  print_measured(results, by_isa, kOpenCv);
  Cells like_for_like = {kOpenCv, "xsobel", "xsobel, 1/16 px"};
  if (has_sse41) like_for_like.emplace_back("same, sse41");
  std::cout << "\n";
  print_row("Like for like, one thread", like_for_like);
  print_measured(results, like_for_like, kOpenCv);
}

}  // namespace stereod::bench
