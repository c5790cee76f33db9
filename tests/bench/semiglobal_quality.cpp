// The semi-global matcher beside OpenCV's SGBM in its 3WAY mode: on pictures with ground truth, on the same
// pictures disturbed, and on thin poles.
//
// bad-1 is the share, in percent, of pixels off by more than 1 px. OpenCV leaves as many columns empty at the
// left border as it searches disparities; here it gets pictures that are wider by so much, so that it can
// answer there too.
#include <array>
#include <cstdio>
#include <exception>
#include <iostream>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "daemon/tools/evaluation.h"
#include "tests/bench/quality_matchers.h"
#include "tests/bench/stereo_sets.h"

namespace stereod::bench {
namespace {

QualityMatcher preset(const std::string& name, int p2) {
  MatcherOptions options = matcher_preset(name).value();
  options.p2 = p2;
  return own_matcher(name + (p2 == MatcherOptions{}.p2 ? "" : " p2 " + std::to_string(p2)), options);
}

QualityMatcher filled_fine() {
  MatcherOptions options = matcher_preset("fine").value();
  options.fill = true;
  return own_matcher("fine filled", options);
}

std::vector<QualityMatcher> matchers() {
  return {opencv_bm_without_tests(), opencv_sgbm_padded(0), opencv_sgbm_padded(10), preset("dense", 40),
          preset("dense", 56),       filled_fine(),         preset("robust", 40),   preset("fine", 40)};
}

// --- disturbances

struct Pictures {
  cv::Mat left, right;
};
using Disturbance = std::pair<const char*, Pictures (*)(const Pictures&)>;

cv::Mat noisy(const cv::Mat& picture, std::uint64_t seed) {
  constexpr double kSigma = 3;
  cv::Mat noise(picture.size(), CV_32F), sum;
  cv::RNG(seed).fill(noise, cv::RNG::NORMAL, 0, kSigma);
  cv::add(picture, noise, sum, cv::noArray(), CV_8U);
  return sum;
}

Pictures as_they_are(const Pictures& pair) { return pair; }

Pictures with_noise(const Pictures& pair) { return {noisy(pair.left, 1), noisy(pair.right, 2)}; }

Pictures with_gain(const Pictures& pair) {
  cv::Mat darker;
  pair.right.convertTo(darker, CV_8U, 0.8, 10);
  return {pair.left, darker};
}

Pictures lowered(const Pictures& pair, double rows) {
  cv::Mat moved;
  const cv::Mat shift = (cv::Mat_<double>(2, 3) << 1, 0, 0, 0, 1, rows);
  cv::warpAffine(pair.right, moved, shift, pair.right.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return {pair.left, moved};
}

Pictures with_half_a_row(const Pictures& pair) { return lowered(pair, 0.5); }
Pictures with_a_row(const Pictures& pair) { return lowered(pair, 1); }

cv::Mat compressed(const cv::Mat& picture) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, 70});
  return cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
}

Pictures with_jpeg(const Pictures& pair) { return {compressed(pair.left), compressed(pair.right)}; }

constexpr std::array<Disturbance, 6> kDisturbances{{{"none", as_they_are},
                                                    {"noise of sigma 3", with_noise},
                                                    {"right picture x 0.8 + 10", with_gain},
                                                    {"right picture 1/2 px lower", with_half_a_row},
                                                    {"right picture 1 px lower", with_a_row},
                                                    {"JPEG of quality 70", with_jpeg}}};

// --- poles

/// Poles before a wall: a pole is 40 px of disparity near, the wall 10.
struct Poles {
  StereoSet set;
  cv::Mat1b on_pole;
};

cv::Mat1f texture(cv::RNG& random, cv::Size size) {
  cv::Mat1f noise(size), smooth, scaled;
  random.fill(noise, cv::RNG::UNIFORM, 0, 1);
  cv::GaussianBlur(noise, smooth, {}, 1.2);
  cv::Scalar mean, deviation;
  cv::meanStdDev(smooth, mean, deviation);
  constexpr double kMiddle = 128, kContrast = 35;
  smooth.convertTo(scaled, CV_32F, kContrast / deviation[0], kMiddle - kContrast * mean[0] / deviation[0]);
  return scaled;
}

Poles poles(int width) {
  constexpr int kRows = 240, kColumns = 640, kNear = 40, kFar = 10, kFirst = 121, kStep = 59, kEnd = 600;
  cv::RNG random(3);
  const cv::Mat1f wall = texture(random, {kColumns + 64, kRows});
  cv::Mat1f left = wall(cv::Rect(0, 0, kColumns, kRows)).clone();
  cv::Mat1f right = wall(cv::Rect(kFar, 0, kColumns, kRows)).clone();
  Poles result{{}, cv::Mat1b(kRows, kColumns, std::uint8_t{0})};
  for (int x = kFirst; x < kEnd; x += kStep) {
    cv::Mat1f pole;
    texture(random, {width, kRows}).convertTo(pole, CV_32F, 0.6, 20);
    pole.copyTo(left(cv::Rect(x, 0, width, kRows)));
    pole.copyTo(right(cv::Rect(x - kNear, 0, width, kRows)));
    result.on_pole(cv::Rect(x, 0, width, kRows)) = 1;
  }
  constexpr double kNoise = 2;
  const auto camera = [&](const cv::Mat1f& picture) {
    cv::Mat1f noise(picture.size());
    cv::Mat seen;
    random.fill(noise, cv::RNG::NORMAL, 0, kNoise);
    cv::add(picture, noise, seen, cv::noArray(), CV_8U);
    return seen;
  };
  result.set = {"poles", camera(left), camera(right), Image<float>(kColumns, kRows), 64};
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      result.set.truth.at(x, y) = static_cast<float>(result.on_pole(y, x) != 0 ? kNear : kFar);
    }
  }
  return result;
}

double share_found(const QualityMatcher& matcher, const Poles& poles) {
  const DisparityImage found = matcher.match(poles.set, poles.set.disparities);
  int on = 0, right = 0;
  for (int y = 0; y < found.height(); ++y) {
    for (int x = 0; x < found.width(); ++x) {
      if (poles.on_pole(y, x) == 0) continue;
      ++on;
      const double px = static_cast<double>(found.at(x, y)) / matcher.units_per_pixel;
      if (found.at(x, y) >= 0 && std::abs(px - static_cast<double>(poles.set.truth.at(x, y))) <= 1) ++right;
    }
  }
  return 100.0 * right / on;
}

// --- tables

Evaluation judge(const QualityMatcher& matcher, const StereoSet& set) {
  return evaluate(matcher.match(set, set.disparities).view(), matcher.units_per_pixel, set.truth.view(), 1);
}

void print_headings(const char* label, const std::vector<QualityMatcher>& all) {
  std::printf("\n%-28s", label);
  for (const QualityMatcher& matcher : all) std::printf("%22s", matcher.name.c_str());
  std::printf("\n");
}

struct Figures {
  double all = 0, matched = 0, density = 0;
  void add(const Evaluation& e, double share) {
    all += share * e.bad1_known, matched += share * e.bad1_matched, density += share * e.density;
  }
  void print() const { std::printf("%8.2f%7.2f%7.1f", all, matched, density); }
};

void print_sets(const std::vector<QualityMatcher>& all, const std::vector<StereoSet>& sets) {
  print_headings("bad-1 all, matched; density", all);
  std::vector<Figures> means(all.size());
  for (const StereoSet& set : sets) {
    std::printf("%-28s", set.name.c_str());
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Evaluation e = judge(all[i], set);
      Figures figures;
      figures.add(e, 1);
      figures.print();
      means[i].add(e, 1.0 / static_cast<double>(sets.size()));
    }
    std::printf("\n");
    std::fflush(stdout);
  }
  std::printf("%-28s", "mean");
  for (const Figures& mean : means) mean.print();
  std::printf("\n");
}

void print_disturbances(const std::vector<QualityMatcher>& all, std::vector<StereoSet>& sets) {
  print_headings("disturbed, mean", all);
  for (const auto& [name, disturb] : kDisturbances) {
    std::printf("%-28s", name);
    std::vector<Figures> means(all.size());
    for (StereoSet& set : sets) {
      const Pictures clean{set.left, set.right};
      const Pictures disturbed = disturb(clean);
      set.left = disturbed.left, set.right = disturbed.right;
      for (std::size_t i = 0; i < all.size(); ++i) {
        means[i].add(judge(all[i], set), 1.0 / static_cast<double>(sets.size()));
      }
      set.left = clean.left, set.right = clean.right;
    }
    for (const Figures& mean : means) mean.print();
    std::printf("\n");
    std::fflush(stdout);
  }
}

void print_poles(const std::vector<QualityMatcher>& all) {
  print_headings("pixels on poles found, %", all);
  for (const int width : {3, 4, 6, 8}) {
    const Poles scene = poles(width);
    std::printf("%-28s", ("poles of " + std::to_string(width) + " px").c_str());
    for (const QualityMatcher& matcher : all) std::printf("%22.1f", share_found(matcher, scene));
    std::printf("\n");
  }
}

int run(const std::vector<std::string>& names) {
  StereoSets found = load_stereo_sets(names);
  for (const std::string& missing : found.missing) std::cout << "skipped: " << missing << "\n";
  const std::vector<QualityMatcher> all = matchers();
  for (const QualityMatcher& matcher : all) {
    std::printf("%s: %s\n", matcher.name.c_str(), matcher.settings.c_str());
  }
  print_sets(all, found.sets);
  // Disturbed: the 18 Middlebury sets.
  std::erase_if(found.sets, [](const StereoSet& set) { return set.name.rfind("mb", 0) != 0; });
  if (!found.sets.empty()) print_disturbances(all, found.sets);
  print_poles(all);
  return 0;
}

}  // namespace
}  // namespace stereod::bench

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  try {
    return stereod::bench::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::cerr << "semiglobal_quality: " << error.what() << "\n";
    return 2;
  }
}
