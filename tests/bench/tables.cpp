// SPDX-License-Identifier: BSD-3-Clause
// Formatting of measurements as tables.
#include "tests/bench/tables.h"

#include <cmath>
#include <iomanip>
#include <iostream>
#include <sstream>

namespace stereod::bench {
namespace {

std::string number(double value, const std::string& unit) {
  std::ostringstream text;
  text << std::fixed
       << std::setprecision(value < 0.1   ? 4
                            : value < 10  ? 3
                            : value < 100 ? 2
                                          : 0)
       << value << unit;
  return text.str();
}

}  // namespace

std::string ms(double value) { return number(value, " ms"); }
std::string times(double value) { return number(value, " x"); }

void print_row(const std::string& label, const Cells& cells) {
  std::cout << std::left << std::setw(40) << label << std::right;
  for (const std::string& cell : cells) std::cout << std::setw(17) << cell;
  std::cout << "\n";
}

void print_measured(const InterleavedResults& results, const Cells& contestants,
                    const std::string& reference) {
  Cells best, median, faster;
  for (const std::string& name : contestants) {
    best.push_back(ms(results.of(name).best));
    median.push_back(ms(results.of(name).median));
    faster.push_back(name == reference ? "1" : times(results.ratio(reference, name)));
  }
  print_row("  here, best", best);
  print_row("  here, median", median);
  print_row("    as fast as " + reference, faster);
}

void print_thesis(const std::string& machine, const std::vector<double>& milliseconds) {
  const double reference = milliseconds.front();
  Cells values, faster;
  for (std::size_t i = 0; i < milliseconds.size(); ++i) {
    const double value = milliseconds[i];
    values.push_back(std::isnan(value) ? "-" : ms(value));
    faster.push_back(std::isnan(value) ? "-" : i == 0 ? "1" : times(reference / value));
  }
  print_row("  thesis, " + machine, values);
  print_row("    as fast as its OpenCV", faster);
}

}  // namespace stereod::bench
