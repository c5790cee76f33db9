// SPDX-License-Identifier: BSD-3-Clause
// How good the depth is: our presets and OpenCV's matchers on images with ground truth.
//
// bad-1 is the share of pixels that are off by more than 1 px, over all whose truth is known (an unmatched
// one counts as bad) and over the matched ones; all shares are in percent. Where the images come from:
// stereo_sets.h. To tune a preset: depth_quality --matchers robust,custom --base robust --set window=9.
#include <algorithm>
#include <exception>
#include <iostream>
#include <opencv2/core/utility.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/bench/quality_arguments.h"
#include "tests/bench/quality_images.h"
#include "tests/bench/quality_matchers.h"
#include "tests/bench/quality_report.h"
#include "tests/bench/stereo_sets.h"

namespace stereod::bench {
namespace {

/// Gray levels per pixel of disparity in the images that are compared by squared difference.
double gray_per_px(int disparities) { return 255.0 / disparities; }

SetResult judge(const QualityMatcher& matcher, const StereoSet& set, int disparities) {
  const DisparityImage found = matcher.match(set, disparities);
  return {set.name,
          evaluate(found.view(), matcher.units_per_pixel, set.truth.view(), gray_per_px(disparities))};
}

MatcherResult judge(const QualityMatcher& matcher, const std::vector<StereoSet>& sets) {
  MatcherResult result{matcher.name, matcher.settings, {}};
  for (const StereoSet& set : sets) result.sets.push_back(judge(matcher, set, set.disparities));
  return result;
}

/// Returns the contestants, BM first.
std::vector<QualityMatcher> contestants(const QualityArguments& arguments) {
  std::vector<QualityMatcher> all = {opencv_bm(), opencv_sgbm_3way()};
  for (const char* preset : {"thesis", "fast", "robust"}) {
    all.push_back(own_matcher(preset, matcher_preset(preset).value()));
  }
  if (arguments.custom) all.push_back(own_matcher("custom", *arguments.custom));
  const std::vector<std::string>& names = arguments.matchers;
  const auto is = [](const std::string& name) {
    return [&name](const QualityMatcher& matcher) {
      return matcher.name == name || matcher.name.rfind(name + " ", 0) == 0;
    };
  };
  for (const std::string& name : names) {
    if (std::none_of(all.begin(), all.end(), is(name))) {
      throw std::runtime_error("there is no matcher called " + name +
                               (name == "custom" ? "; it is made with --set" : ""));
    }
  }
  std::erase_if(all, [&](const QualityMatcher& matcher) {
    return !names.empty() && matcher.name != "BM" &&
           std::none_of(names.begin(), names.end(), [&](const auto& name) { return is(name)(matcher); });
  });
  return all;
}

void print_results(const std::vector<QualityMatcher>& matchers, const std::vector<StereoSet>& sets) {
  std::vector<MatcherResult> results;
  results.reserve(matchers.size());
  for (const QualityMatcher& matcher : matchers) results.push_back(judge(matcher, sets));
  const MatcherResult& bm = results.front();
  for (const MatcherResult& result : results) print_table(result, bm);
  std::cout << "\n";
  for (const MatcherResult& result : results) {
    if (result.name == "robust" || result.name == "custom") print_trust_against(result, bm);
    if (result.name == "fast" || result.name == "custom") print_coverage_against(result, bm);
  }
}

/// Prints the comparison of the thesis' section 3.6.
void print_thesis_comparison(const std::vector<StereoSet>& sets) {
  const auto tsukuba = std::find_if(sets.begin(), sets.end(),
                                    [](const StereoSet& set) { return set.name == "mb2001_tsukuba"; });
  if (tsukuba == sets.end()) return;
  constexpr int kDisparities = 64;
  std::cout << "\nAs in the thesis, section 3.6: Tsukuba, 64 disparities, 11x11. Mean squared difference of "
               "8-bit images (here "
            << gray_per_px(kDisparities)
            << " gray levels a px,\nover the known pixels; the thesis does not say its own scale): thesis "
               "OpenCV 6457, its naive matcher 4746.\n";
  std::vector<MatcherResult> results;
  for (const QualityMatcher& matcher :
       {opencv_bm_without_tests(), own_matcher("thesis", matcher_preset("thesis").value())}) {
    results.push_back({matcher.name, matcher.settings, {judge(matcher, *tsukuba, kDisparities)}});
  }
  print_squared_differences(results);
}

/// Writes an image for each set: left image, ground truth, BM and, where they take part, robust and custom.
void write_images(const std::filesystem::path& directory, const std::vector<QualityMatcher>& matchers,
                  const std::vector<StereoSet>& sets) {
  std::filesystem::create_directories(directory);
  for (const StereoSet& set : sets) {
    std::vector<FoundDisparity> found;
    for (const QualityMatcher& matcher : matchers) {
      if (matcher.name != "BM" && matcher.name != "robust" && matcher.name != "custom") continue;
      found.push_back({matcher.match(set, set.disparities), matcher.units_per_pixel});
    }
    write_comparison(directory / (set.name + ".png"), set, found);
  }
  std::cout << "\nImages are in " << directory.string()
            << ": left image, ground truth, BM, robust (then custom).\n";
}

int run(const QualityArguments& arguments) {
  const StereoSets found = load_stereo_sets(arguments.sets);
  for (const std::string& missing : found.missing) std::cout << "skipped: " << missing << "\n";
  if (found.sets.empty()) return 1;
  const std::vector<QualityMatcher> matchers = contestants(arguments);
  std::cout << "OpenCV " << CV_VERSION << ", " << found.sets.size()
            << " sets; bad-1: off by more than 1 px, % of all known pixels and of the matched ones.\n";
  print_results(matchers, found.sets);
  print_thesis_comparison(found.sets);
  if (arguments.image_directory) write_images(*arguments.image_directory, matchers, found.sets);
  return 0;
}

}  // namespace
}  // namespace stereod::bench

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  try {
    return stereod::bench::run(stereod::bench::parse_quality_arguments(argc, argv));
  } catch (const std::exception& error) {
    std::cerr << "depth_quality: " << error.what() << "\n";
    return 2;
  }
}
