// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/base/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace stereod {

std::string progress_bar(std::size_t done, std::size_t total, std::size_t width) {
  const std::size_t filled = total == 0 ? width : std::min(width, done * width / total);
  return "[" + std::string(filled, '#') + std::string(width - filled, '.') + "]";
}

Progress::Progress(std::string what, std::size_t total)
    : what_(std::move(what)), total_(total), shown_(::isatty(STDERR_FILENO) == 1) {
  draw();
}

Progress::~Progress() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void Progress::step() {
  ++done_;
  draw();
}

void Progress::draw() const {
  if (!shown_) return;
  std::fprintf(stderr, "\r%s %zu/%zu %s", progress_bar(done_, total_, 30).c_str(), done_, total_,
               what_.c_str());
  std::fflush(stderr);
}

}  // namespace stereod
