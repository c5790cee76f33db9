// SPDX-License-Identifier: BSD-3-Clause
// Draws a progress bar.
#pragma once

#include <cstddef>
#include <string>

namespace stereod {

/// Draws a bar on stderr and clears it at the end. Silent if stderr is not a terminal.
class Progress {
 public:
  Progress(std::string what, std::size_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void step();

 private:
  void draw() const;

  std::string what_;
  std::size_t total_;
  std::size_t done_ = 0;
  bool shown_;
};

/// Returns "[#####.....]" for @p done of @p total parts, @p width characters between the brackets.
std::string progress_bar(std::size_t done, std::size_t total, std::size_t width);

}  // namespace stereod
