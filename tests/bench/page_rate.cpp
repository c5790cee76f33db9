// SPDX-License-Identifier: BSD-3-Clause
// How many images a second stereo-view's page shows in a headless Chromium, whole and at half resolution.
//
//   page_rate URL SECONDS
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <thread>

#include "tests/support/chromium.h"
#include "tests/support/temporary_directory.h"

namespace stereod {
namespace {

double shown_per_second(Chromium& browser, double seconds) {
  std::this_thread::sleep_for(std::chrono::seconds(2));  // what is under way is not measured
  const std::string state = "[view.shown, performance.now()].join(' ')";
  const auto read = [&](long& shown, double& ms) {
    if (std::sscanf(browser.evaluate(state).c_str(), "%ld %lf", &shown, &ms) != 2) {
      throw std::runtime_error("the page does not say how many images it has shown.");
    }
  };
  long before = 0, after = 0;
  double begin = 0, end = 0;
  read(before, begin);
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  read(after, end);
  return static_cast<double>(after - before) * 1e3 / (end - begin);
}

int run(int argc, char** argv) {
  const auto program = Chromium::program();
  if (argc != 3 || !program) {
    std::fprintf(stderr, "usage: page_rate URL SECONDS (and Chromium has to be there)\n");
    return 1;
  }
  const TemporaryDirectory scratch;
  Chromium browser(*program, scratch.path());
  browser.open(argv[1], 1400, 1500);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (browser.evaluate("typeof view === 'undefined' ? 0 : Math.sign(view.shown)") != "1") {
    if (std::chrono::steady_clock::now() > deadline) throw std::runtime_error("the page shows nothing.");
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  const double seconds = std::atof(argv[2]);
  const double whole = shown_per_second(browser, seconds);
  browser.evaluate("document.getElementById('half').checked = true");
  const double half = shown_per_second(browser, seconds);
  browser.evaluate("view.cloud.show = () => {}");
  browser.evaluate("view.cloud.draw = () => {}");
  const double no_cloud = shown_per_second(browser, seconds);
  std::printf("whole: %.1f, half resolution: %.1f, half and no point cloud: %.1f images a second\n", whole,
              half, no_cloud);
  return 0;
}

}  // namespace
}  // namespace stereod

int main(int argc, char** argv) {
  try {
    return stereod::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "page_rate: %s\n", error.what());
    return 1;
  }
}
