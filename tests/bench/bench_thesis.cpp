// SPDX-License-Identifier: BSD-3-Clause
// The thesis' tables, measured on this machine: matching (tables 3.1, 3.2, 3.4, 3.5 and figure 3.13) and
// remapping (tables 4.2 and 4.3), each followed by the numbers that the thesis gives.
//
// Usage: bench_thesis [rounds]. All contestants of a table take turns within one run.
#include "tests/bench/bench_thesis.h"

#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <opencv2/core.hpp>
#include <string>
#include <thread>

namespace {

std::string cpu_name() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "this machine";
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 60;
  if (rounds < 1) {
    std::cerr << "usage: bench_thesis [rounds, at least 1]\n";
    return 2;
  }
  cv::setNumThreads(1);
  std::cout << cpu_name() << ", " << std::thread::hardware_concurrency() << " CPUs, OpenCV " << CV_VERSION
            << ", " << rounds << " rounds. Ratios are medians of the ratios within a round.\n";
  try {
    stereod::bench::measure_matching(rounds);
    stereod::bench::measure_remapping(rounds);
  } catch (const std::exception& error) {
    std::cerr << "bench_thesis: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
