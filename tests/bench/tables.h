// SPDX-License-Identifier: BSD-3-Clause
// Prints measurements in the layout of the thesis' tables.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/interleaved.h"

namespace stereod::bench {

using Cells = std::vector<std::string>;

/// A number with as many digits as mean something, in milliseconds, or as a factor.
std::string ms(double value);
std::string times(double value);

/// One line: a label and a cell for each column.
void print_row(const std::string& label, const Cells& cells);

/// Three lines, a column for each contestant: best, median, and how many times as fast as `reference`.
void print_measured(const InterleavedResults& results, const Cells& contestants,
                    const std::string& reference);

/// What the thesis measured on `machine`, and how many times as fast as its first column that is. NaN: no
/// such column in the thesis.
void print_thesis(const std::string& machine, const std::vector<double>& milliseconds);

}  // namespace stereod::bench
