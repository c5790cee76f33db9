// SPDX-License-Identifier: BSD-3-Clause
// The matcher beside OpenCV's StereoBM: every setting, instruction set and number of threads.
//
// Usage: bench_matcher [rounds]. In each row all contestants take turns within one run; a factor is the speed
// relative to OpenCV, by the best times. Run it on an idle machine or with a high priority: beside other
// programs even the best of a few rounds is too slow.
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/base/cpu.h"
#include "core/match/frame_matcher.h"
#include "tests/bench/interleaved.h"
#include "tests/bench/matcher_cases.h"
#include "tests/bench/tables.h"

namespace stereod::bench {
namespace {

constexpr const char* kOpenCv = "OpenCV";

/// A matcher with its threads and the memory for its disparities.
class OwnMatcher {
 public:
  OwnMatcher(const MatcherCase& the_case, const MatcherOptions& options, int workers)
      : pair_(the_case.pair),
        pool_(workers),
        matcher_(options, view_of(pair_.left).size(), pool_),
        answer_(view_of(pair_.left).size()) {}
  void match() { matcher_.match(view_of(pair_.left), view_of(pair_.right), answer_.view()); }

 private:
  MatPair pair_;
  WorkerPool pool_;
  FrameMatcher matcher_;
  DisparityImage answer_;
};

/// The contestants of one setting.
class Contest {
 public:
  void add_opencv(const MatcherCase& the_case) {
    const cv::Ptr<cv::StereoBM> matcher = opencv_matcher(the_case.options);
    const auto out = std::make_shared<cv::Mat>();
    const MatPair pair = the_case.pair;
    run_.add(kOpenCv, [=] { matcher->compute(pair.left, pair.right, *out); });
  }

  void add_sgbm(const std::string& name, const MatcherCase& the_case) {
    constexpr int kBlock = 5;
    const cv::Ptr<cv::StereoSGBM> matcher =
        cv::StereoSGBM::create(0, the_case.options.disparities, kBlock, 8 * kBlock * kBlock,
                               32 * kBlock * kBlock, 0, 31, 0, 0, 0, cv::StereoSGBM::MODE_SGBM_3WAY);
    const auto out = std::make_shared<cv::Mat>();
    const MatPair pair = the_case.pair;
    run_.add(name, [=] { matcher->compute(pair.left, pair.right, *out); });
  }

  void add(const std::string& name, const MatcherCase& the_case, const MatcherOptions& options, int workers) {
    matchers_.push_back(std::make_unique<OwnMatcher>(the_case, options, workers));
    OwnMatcher& matcher = *matchers_.back();
    run_.add(name, [&matcher] { matcher.match(); });
  }

  InterleavedResults run(int rounds) const { return run_.run(rounds); }

 private:
  std::vector<std::unique_ptr<OwnMatcher>> matchers_;
  InterleavedRun run_;
};

MatcherOptions with_isa(MatcherOptions options, Isa isa) {
  options.isa = isa;
  return options;
}

std::string best_and_factor(const InterleavedResults& results, const std::string& name) {
  const double best = results.of(name).best;
  return ms(best) + " " + times(results.of(kOpenCv).best / best);
}

void measure_against_opencv(const std::vector<MatcherCase>& cases, int workers, int rounds) {
  cv::setNumThreads(workers);
  Cells headings{kOpenCv};
  for (const Isa isa : available_isas()) headings.emplace_back(name_of(isa));
  std::cout << "\n";
  print_row(workers == 1 ? "1 thread" : std::to_string(workers) + " threads", headings);
  for (const MatcherCase& the_case : cases) {
    Contest contest;
    contest.add_opencv(the_case);
    for (const Isa isa : available_isas()) {
      contest.add(std::string(name_of(isa)), the_case, with_isa(the_case.options, isa), workers);
    }
    const InterleavedResults results = contest.run(rounds);
    Cells cells{ms(results.of(kOpenCv).best)};
    for (const Isa isa : available_isas())
      cells.push_back(best_and_factor(results, std::string(name_of(isa))));
    print_row(the_case.name, cells);
  }
}

/// Prints the time of each contestant relative to the first.
void measure_among_each_other(const std::string& title, const std::vector<MatcherCase>& cases, int rounds) {
  if (cases.empty()) return;
  Cells headings;
  for (const MatcherCase& the_case : cases) headings.push_back(the_case.name);
  std::cout << "\n";
  print_row(title, headings);
  for (const Isa isa : available_isas()) {
    Contest contest;
    for (const MatcherCase& the_case : cases) {
      contest.add(the_case.name, the_case, with_isa(the_case.options, isa), 1);
    }
    const InterleavedResults results = contest.run(rounds);
    Cells cells;
    for (const std::string& name : headings) {
      cells.push_back(times(results.of(name).best / results.of(headings.front()).best));
    }
    print_row(std::string(name_of(isa)), cells);
  }
}

/// Prints the speedup of two threads and the cost of the mode for small caches.
void measure_modes(const MatcherCase& the_case, int rounds) {
  std::cout << "\n";
  print_row(the_case.name, {"1 thread", "2 threads", "small caches"});
  for (const Isa isa : available_isas()) {
    MatcherOptions large = with_isa(the_case.options, isa);
    large.cache = CacheUse::kLarge;
    MatcherOptions small = large;
    small.cache = CacheUse::kSmall;
    Contest contest;
    contest.add("1", the_case, large, 1);
    contest.add("2", the_case, large, 2);
    contest.add("small", the_case, small, 1);
    const InterleavedResults results = contest.run(rounds);
    const double one = results.of("1").best;
    print_row(std::string(name_of(isa)),
              {ms(one), times(one / results.of("2").best), times(one / results.of("small").best)});
  }
}

/// Measures the semi-global matcher's presets beside StereoBM with a block of 11×11 and its tests off.
void measure_semiglobal(const std::vector<MatcherCase>& cases, int rounds) {
  constexpr const char* kSgbm = "SGBM 3WAY";
  for (const char* preset : {"dense", "fine"}) {
    Cells headings{kOpenCv, kSgbm};
    for (const Isa isa : available_isas()) {
      headings.emplace_back(name_of(isa));
      headings.emplace_back("2 threads");
    }
    std::cout << "\n";
    print_row(std::string("semi-global, ") + preset, headings);
    cv::setNumThreads(1);
    for (const MatcherCase& the_case : cases) {
      Contest contest;
      contest.add_opencv(the_case);
      contest.add_sgbm(kSgbm, the_case);
      MatcherOptions options = *matcher_preset(preset);
      options.disparities = the_case.options.disparities;
      for (const Isa isa : available_isas()) {
        for (const int workers : {1, 2}) {
          contest.add(std::string(name_of(isa)) + std::to_string(workers), the_case, with_isa(options, isa),
                      workers);
        }
      }
      const InterleavedResults results = contest.run(rounds);
      Cells cells{ms(results.of(kOpenCv).best), ms(results.of(kSgbm).best)};
      for (const Isa isa : available_isas()) {
        const std::string name(name_of(isa));
        cells.push_back(best_and_factor(results, name + "1"));
        cells.push_back(times(results.of(name + "1").best / results.of(name + "2").best));
      }
      print_row(the_case.name, cells);
    }
  }
}

/// Returns the scratch memory of a worker [bytes].
void print_scratch() {
  std::cout << "\nScratch memory at 640x480, 64 disparities:";
  for (const char* preset : {"robust", "dense", "fine", "fast"}) {
    const auto matcher = make_band_matcher(*matcher_preset(preset), {640, 480});
    std::cout << " " << preset << " " << matcher->scratch_bytes() / 1024 << " KiB";
  }
  std::cout << "\n";
}

void measure(int rounds) {
  measure_semiglobal(semiglobal_cases(), rounds);
  print_scratch();
  const std::vector<MatcherCase> cases = speed_cases();
  if (cases.empty()) return;
  for (const int workers : {1, 2}) measure_against_opencv(cases, workers, rounds);
  measure_among_each_other("times as long as", odd_cases(), rounds);
  measure_modes(cases.front(), rounds);
}

}  // namespace
}  // namespace stereod::bench

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 60;
  if (rounds < 1) {
    std::cerr << "usage: bench_matcher [rounds, at least 1]\n";
    return 2;
  }
  std::cout << "OpenCV " << CV_VERSION << " StereoBM and ours, same parameters and images, " << rounds
            << " rounds. OpenCV always prefilters and always answers in 1/16 px.\n";
  stereod::bench::measure(rounds);
  return 0;
}
