// One frame of the block matcher and of OpenCV's, by picture, prefilter and instruction set, on one thread.
// To be read for one contestant at a time; for ratios see bench_thesis, which lets the contestants take
// turns.
#include <benchmark/benchmark.h>

#include <iostream>
#include <opencv2/calib3d.hpp>
#include <string>

#include "core/match/frame_matcher.h"
#include "core/match/isa.h"
#include "tests/bench/bench_images.h"

namespace stereod::bench {
namespace {

constexpr int kDisparities = 64;
constexpr int kWindow = 11;

/// The fastest settings, and those that answer in 1/16 px as OpenCV's always do.
MatcherOptions options_for(Prefilter prefilter, bool subpixel, Isa isa) {
  MatcherOptions options;
  options.disparities = kDisparities;
  options.window = kWindow;
  options.prefilter = prefilter;
  options.subpixel = subpixel;
  options.isa = isa;
  return options;
}

void match_own(benchmark::State& state, const MatPair& pair, const MatcherOptions& options) {
  WorkerPool pool(1);
  FrameMatcher matcher(options, view_of(pair.left).size(), pool);
  DisparityImage out(view_of(pair.left).size());
  for ([[maybe_unused]] auto turn : state) {
    matcher.match(view_of(pair.left), view_of(pair.right), out.view());
    benchmark::ClobberMemory();
  }
}

/// XSobel prefilter (it cannot do without one), no test and no filter behind it.
void match_opencv(benchmark::State& state, const MatPair& pair) {
  cv::setNumThreads(1);
  const cv::Ptr<cv::StereoBM> matcher = cv::StereoBM::create(kDisparities, kWindow);
  matcher->setTextureThreshold(0);
  matcher->setUniquenessRatio(0);
  cv::Mat out;
  for ([[maybe_unused]] auto turn : state) matcher->compute(pair.left, pair.right, out);
}

void register_picture(const std::string& picture, const MatPair& pair) {
  const auto add = [](const std::string& name, auto&& function) {
    benchmark::RegisterBenchmark(name.c_str(), function)->Unit(benchmark::kMillisecond);
  };
  add("opencv/" + picture + "/xsobel/subpixel",
      [pair](benchmark::State& state) { match_opencv(state, pair); });
  for (const Isa isa : available_isas()) {
    for (const Prefilter prefilter : {Prefilter::kNone, Prefilter::kXsobel}) {
      for (const bool subpixel : {false, true}) {
        const std::string name = std::string(name_of(isa)) + "/" + picture + "/" +
                                 std::string(name_of(prefilter)) + (subpixel ? "/subpixel" : "");
        const MatcherOptions options = options_for(prefilter, subpixel, isa);
        add(name, [pair, options](benchmark::State& state) { match_own(state, pair, options); });
      }
    }
  }
}

void register_all() {
  if (const std::optional<MatPair> tsukuba = load_tsukuba()) {
    register_picture("384x288", *tsukuba);
  } else {
    std::cerr << "skipped: no Tsukuba pictures in " << datasets()
              << "; set STEREO_DATASETS to where they are\n";
  }
  if (const std::optional<MatPair> aloe = load_aloe_vga()) {
    register_picture("640x480", {grey_of(aloe->left), grey_of(aloe->right)});
  } else {
    std::cerr << "skipped: no Aloe pictures; install the package opencv-doc\n";
  }
}

}  // namespace
}  // namespace stereod::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  stereod::bench::register_all();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
