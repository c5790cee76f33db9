// SPDX-License-Identifier: BSD-3-Clause
// The measured settings, for stereod's matcher and for OpenCV's StereoBM.
#include "tests/bench/matcher_cases.h"

#include <iostream>

namespace stereod::bench {
namespace {

/// Returns options for XSobel with OpenCV's cap, no test, no filter, whole pixels.
MatcherOptions plain(int disparities, int window) {
  MatcherOptions options;
  options.disparities = disparities;
  options.window = window;
  options.subpixel = false;
  return options;
}

MatcherOptions with_subpixel(MatcherOptions options) {
  options.subpixel = true;
  return options;
}

MatcherOptions without_prefilter(MatcherOptions options) {
  options.prefilter = Prefilter::kNone;
  return options;
}

/// Returns options with all of OpenCV's tests at usual values.
MatcherOptions with_filters(MatcherOptions options) {
  options.subpixel = true;
  options.texture_threshold = 10;
  options.uniqueness_ratio = 15;
  options.left_right_max_diff = 1;
  options.speckle_size = 100;
  options.speckle_max_diff = 2;
  return options;
}

class CaseList {
 public:
  void add(const std::string& name, const std::optional<MatPair>& pair, const MatcherOptions& options) {
    if (pair) cases_.push_back({name, *pair, options});
  }
  std::vector<MatcherCase> take() { return std::move(cases_); }

 private:
  std::vector<MatcherCase> cases_;
};

std::optional<MatPair> aloe(cv::Size size) {
  std::optional<MatPair> pair = load_aloe(size);
  if (!pair) {
    std::cerr << "skipped: no Aloe images; install the package opencv-doc\n";
    return std::nullopt;
  }
  return MatPair{gray_of(pair->left), gray_of(pair->right)};
}

}  // namespace

std::vector<MatcherCase> speed_cases() {
  const std::optional<MatPair> vga = aloe({640, 480});
  const std::optional<MatPair> tsukuba = load_tsukuba();
  if (!tsukuba) {
    std::cerr << "skipped: no Tsukuba images in " << datasets()
              << "; set STEREO_DATASETS to where they are\n";
  }
  CaseList list;
  list.add("640x480 d64 w11", vga, plain(64, 11));
  list.add("same, raw gray values", vga, without_prefilter(plain(64, 11)));
  list.add("same as first, 1/16 px", vga, with_subpixel(plain(64, 11)));
  list.add("same, all filters", vga, with_filters(plain(64, 11)));
  list.add("640x480 d128 w15", vga, plain(128, 15));
  list.add("1280x720 d128 w11", aloe({1280, 720}), plain(128, 11));
  list.add("Tsukuba 384x288 d64 w11", tsukuba, plain(64, 11));
  list.add("320x240 d48 w9", aloe({320, 240}), plain(48, 9));
  return list.take();
}

std::vector<MatcherCase> semiglobal_cases() {
  CaseList list;
  list.add("640x480 d64", aloe({640, 480}), plain(64, 11));
  list.add("640x480 d128", aloe({640, 480}), plain(128, 11));
  list.add("1280x720 d128", aloe({1280, 720}), plain(128, 11));
  list.add("384x288 d64", load_tsukuba(), plain(64, 11));
  list.add("320x240 d48", aloe({320, 240}), plain(48, 11));
  return list.take();
}

std::vector<MatcherCase> odd_cases() {
  const std::optional<MatPair> vga = aloe({640, 480});
  CaseList list;
  list.add("d64 w11", vga, plain(64, 11));
  list.add("d50 w11", vga, plain(50, 11));
  list.add("d64 w13", vga, plain(64, 13));
  list.add("d64 w21", vga, plain(64, 21));
  list.add("d64 w31", vga, plain(64, 31));
  list.add("raw w11", vga, without_prefilter(plain(64, 11)));
  list.add("raw w21", vga, without_prefilter(plain(64, 21)));
  return list.take();
}

cv::Ptr<cv::StereoBM> opencv_matcher(const MatcherOptions& options) {
  constexpr int kStep = 16;
  const int disparities = (options.disparities + kStep - 1) / kStep * kStep;
  cv::Ptr<cv::StereoBM> matcher = cv::StereoBM::create(disparities, options.window);
  matcher->setTextureThreshold(options.texture_threshold);
  matcher->setUniquenessRatio(options.uniqueness_ratio);
  matcher->setDisp12MaxDiff(options.left_right_max_diff);
  matcher->setSpeckleWindowSize(options.speckle_size);
  matcher->setSpeckleRange(options.speckle_max_diff * 16);
  matcher->setPreFilterCap(options.prefilter_cap);
  return matcher;
}

}  // namespace stereod::bench
