// SPDX-License-Identifier: BSD-3-Clause
// Timing that can be compared: contestants take turns within one run.
//
// On shared or clocked-down machines the same program is 1.5 times slower a minute later, so times of two
// runs say nothing about each other. Here every round gives each contestant one turn, and a ratio is
// one of best times, or the median, over the rounds that both took part in, of the ratio within the round. A
// ratio of contestants from different runs cannot be asked for: results are looked up by name in the run that
// produced them.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace stereod::bench {

/// Times of one call [ms].
struct Timing {
  double best = 0;
  double median = 0;
};

/// The times of one run. An unknown name throws std::out_of_range.
class InterleavedResults {
 public:
  Timing of(const std::string& name) const {
    std::vector<double> times;
    for (const double ms : turns_.at(name)) {
      if (!std::isnan(ms)) times.push_back(ms);
    }
    return {*std::min_element(times.begin(), times.end()), median(times)};
  }

  /// Returns the time of a call of @p name divided by that of @p other.
  double ratio(const std::string& name, const std::string& other) const {
    const std::vector<double>& a = turns_.at(name);
    const std::vector<double>& b = turns_.at(other);
    std::vector<double> ratios;
    for (std::size_t round = 0; round < a.size(); ++round) {
      if (!std::isnan(a[round]) && !std::isnan(b[round])) ratios.push_back(a[round] / b[round]);
    }
    return median(ratios);
  }

 private:
  friend class InterleavedRun;

  static double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
  }

  std::map<std::string, std::vector<double>> turns_;  // one for each round; NaN where it did not take part
};

/// The contestants of one run.
class InterleavedRun {
 public:
  /// Adds a contestant. @p work is one call; @p at_most limits the turns of a slow contestant, which always
  /// takes part in the first round.
  void add(const std::string& name, std::function<void()> work,
           int at_most = std::numeric_limits<int>::max()) {
    for (const Contestant& contestant : contestants_) {
      if (contestant.name == name) throw std::invalid_argument("two contestants are called " + name);
    }
    contestants_.push_back({name, std::move(work), std::max(1, at_most)});
  }

  /// Gives every contestant one turn a round. A turn is as many calls as fit into 30 ms, so that its first
  /// call, which finds cold caches, has little weight. One call before the first round warms up and
  /// determines this number.
  InterleavedResults run(int rounds) const {
    InterleavedResults results;
    std::map<std::string, int> calls;
    for (const Contestant& contestant : contestants_) {
      contestant.work();
      calls[contestant.name] =
          std::max(1, static_cast<int>(kTurnMs / std::max(1e-4, time_of(contestant, 1))));
    }
    for (int round = 0; round < std::max(1, rounds); ++round) {
      for (const Contestant& contestant : contestants_) {
        const bool takes_part = round < contestant.at_most;
        results.turns_[contestant.name].push_back(takes_part ? time_of(contestant, calls[contestant.name])
                                                             : std::numeric_limits<double>::quiet_NaN());
      }
    }
    return results;
  }

 private:
  static constexpr double kTurnMs = 30;

  struct Contestant {
    std::string name;
    std::function<void()> work;
    int at_most;
  };

  static double time_of(const Contestant& contestant, int calls) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < calls; ++i) contestant.work();
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    return time.count() / calls;
  }

  std::vector<Contestant> contestants_;
};

}  // namespace stereod::bench
