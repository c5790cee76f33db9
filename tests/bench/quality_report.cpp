// SPDX-License-Identifier: BSD-3-Clause
// The tables and sentences of depth_quality.
#include "tests/bench/quality_report.h"

#include <iomanip>
#include <iostream>

namespace stereod::bench {
namespace {

constexpr int kLabel = 20;
constexpr int kColumn = 10;

void print_label(const std::string& label) {
  std::cout << "  " << std::left << std::setw(kLabel) << label << std::right << std::fixed;
}

void print_evaluation(const Evaluation& e) {
  std::cout << std::setprecision(2) << std::setw(kColumn) << e.bad1_known << std::setw(kColumn)
            << e.bad1_matched << std::setw(kColumn) << e.density << std::setprecision(3) << std::setw(kColumn)
            << e.mean_absolute_error;
}

void print_line(const std::string& label, const Evaluation& e, const Evaluation& bm) {
  print_label(label);
  print_evaluation(e);
  std::cout << std::setprecision(2) << std::showpos << "  |" << std::setw(kColumn)
            << e.bad1_known - bm.bad1_known << std::setw(kColumn) << e.bad1_matched - bm.bad1_matched
            << std::setw(kColumn) << e.density - bm.density << std::noshowpos << "\n";
}

/// Returns the mean over the sets; every set has the same weight.
Evaluation mean_of(const MatcherResult& result) {
  Evaluation mean;
  const double share = 1.0 / static_cast<double>(result.sets.size());
  for (const auto& [set, e] : result.sets) {
    mean.bad1_known += share * e.bad1_known;
    mean.bad1_matched += share * e.bad1_matched;
    mean.density += share * e.density;
    mean.mean_absolute_error += share * e.mean_absolute_error;
  }
  return mean;
}

}  // namespace

void print_table(const MatcherResult& result, const MatcherResult& bm) {
  std::cout << "\n" << result.name << " (" << result.settings << ")\n";
  print_label("");
  for (const char* heading : {"bad-1 all", "matched", "density", "error px"}) {
    std::cout << std::setw(kColumn) << heading;
  }
  std::cout << "  |";
  for (const char* heading : {"all-BM", "m.-BM", "dens.-BM"}) std::cout << std::setw(kColumn) << heading;
  std::cout << "\n";
  for (std::size_t i = 0; i < result.sets.size(); ++i) {
    print_line(result.sets[i].set, result.sets[i].evaluation, bm.sets[i].evaluation);
  }
  print_line("mean", mean_of(result), mean_of(bm));
}

void print_trust_against(const MatcherResult& result, const MatcherResult& bm) {
  std::size_t better = 0;
  std::string misses;
  for (std::size_t i = 0; i < result.sets.size(); ++i) {
    const Evaluation& own = result.sets[i].evaluation;
    const Evaluation& other = bm.sets[i].evaluation;
    const bool truer = own.bad1_matched < other.bad1_matched;
    const bool as_dense = own.density >= other.density;
    if (truer && as_dense) {
      ++better;
      continue;
    }
    misses += (misses.empty() ? "" : "; ") + result.sets[i].set + " (" + (truer ? "" : "bad-1") +
              (truer || as_dense ? "" : ", ") + (as_dense ? "" : "density") + ")";
  }
  std::cout << result.name << " against BM: lower bad-1 over matched pixels and at least BM's density on "
            << better << " of " << result.sets.size() << " sets" << (misses.empty() ? "" : "; not on ")
            << misses << ".\n";
}

void print_coverage_against(const MatcherResult& result, const MatcherResult& bm) {
  std::size_t lower = 0;
  std::string misses;
  for (std::size_t i = 0; i < result.sets.size(); ++i) {
    if (result.sets[i].evaluation.bad1_known < bm.sets[i].evaluation.bad1_known) {
      ++lower;
    } else {
      misses += (misses.empty() ? "; not on " : ", ") + result.sets[i].set;
    }
  }
  const double own = mean_of(result).bad1_known;
  const double other = mean_of(bm).bad1_known;
  std::cout << std::setprecision(2) << result.name << " against BM: mean bad-1 over all known pixels " << own
            << " % instead of " << other << " %, " << std::setprecision(1) << 100 * (1 - own / other)
            << " % less; lower on " << lower << " of " << result.sets.size() << " sets" << misses << ".\n";
}

void print_squared_differences(const std::vector<MatcherResult>& results) {
  print_label("");
  for (const char* heading : {"bad-1 all", "matched", "density", "error px", "sq. diff."}) {
    std::cout << std::setw(kColumn) << heading;
  }
  std::cout << "\n";
  for (const MatcherResult& result : results) {
    const Evaluation& e = result.sets.front().evaluation;
    print_label(result.name);
    print_evaluation(e);
    std::cout << std::setprecision(0) << std::setw(kColumn) << e.mean_squared_difference << "\n";
  }
}

}  // namespace stereod::bench
