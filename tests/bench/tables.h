// SPDX-License-Identifier: BSD-3-Clause
// Prints measurements in the layout of the thesis' tables.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/interleaved.h"

namespace stereod::bench {

using Cells = std::vector<std::string>;

/// Formats a number with its significant digits, in milliseconds or as a factor.
std::string ms(double value);
std::string times(double value);

/// Prints one line: a label and a cell for each column.
void print_row(const std::string& label, const Cells& cells);

/// Prints three lines with a column for each contestant: best, median, and the speed relative to
/// @p reference.
void print_measured(const InterleavedResults& results, const Cells& contestants,
                    const std::string& reference);

/// Prints the times of the thesis on @p machine and the speed relative to its first column. NaN: the thesis
/// has no such column.
void print_thesis(const std::string& machine, const std::vector<double>& milliseconds);

}  // namespace stereod::bench
