// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/match/match_report.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace stereod::tools {

namespace {

template <typename... Values>
std::string formatted(const char* format, Values... values) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

}  // namespace

std::string evaluation_table(const Evaluation& evaluation, const std::string& title, double gray_per_px) {
  std::string table = "against " + title + "\n";
  table += formatted("%-26s %10s %10s\n", "", "all known", "matched");
  table += formatted("%-26s %10ld %10ld\n", "pixels", evaluation.known, evaluation.matched);
  table +=
      formatted("%-26s %8.2f %% %8.2f %%\n", "share", evaluation.known > 0 ? 100.0 : 0.0, evaluation.density);
  table += formatted("%-26s %8.2f %% %8.2f %%\n", "off by more than 1 px", evaluation.bad1_known,
                     evaluation.bad1_matched);
  table += formatted("%-26s %8.2f %% %8.2f %%\n", "off by more than 2 px", evaluation.bad2_known,
                     evaluation.bad2_matched);
  table += formatted("%-26s %10s %7.3f px\n", "mean absolute error", "", evaluation.mean_absolute_error);
  table += formatted("%-26s %10.1f            (gray levels, %.4g a px)\n", "mean squared difference",
                     evaluation.mean_squared_difference, gray_per_px);
  return table;
}

std::string filled_line(long measured, long filled, long all) {
  const double share = all > 0 ? 100.0 / static_cast<double>(all) : 0;
  return formatted(
      "measured: %.1f %% of the pixels; filled from neighbors: %.1f %%, not marked in the files "
      "(--no-hole-filling leaves them empty)\n",
      share * static_cast<double>(measured), share * static_cast<double>(filled));
}

std::string timing_line(std::vector<double> times_ms) {
  std::sort(times_ms.begin(), times_ms.end());
  const std::size_t middle = times_ms.size() / 2;
  const double median =
      times_ms.size() % 2 == 1 ? times_ms[middle] : (times_ms[middle - 1] + times_ms[middle]) / 2;
  return formatted("median %.3f ms, minimum %.3f ms\n", median, times_ms.front());
}

}  // namespace stereod::tools
