// SPDX-License-Identifier: BSD-3-Clause
// The semi-global matcher beside OpenCV's SGBM in its 3WAY mode: on images with ground truth, on the same
// images disturbed, where something nearer hides what is there, on thin poles and in a street.
//
// bad-1 is the share, in percent, of pixels off by more than 1 px. OpenCV leaves as many columns empty at the
// left border as it searches disparities; here it gets images that are wider by so much, so that it can
// answer there too.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "daemon/tools/match/evaluation.h"
#include "tests/bench/pole_scene.h"
#include "tests/bench/quality_matchers.h"
#include "tests/bench/stereo_sets.h"
#include "tests/bench/street_scene.h"

namespace stereod::bench {

using tools::evaluate;
using tools::Evaluation;
namespace {

QualityMatcher preset(const std::string& name, int p2) {
  MatcherOptions options = matcher_preset(name).value();
  options.p2 = p2;
  return own_matcher(name + (p2 == MatcherOptions{}.p2 ? "" : " p2 " + std::to_string(p2)), options);
}

QualityMatcher filled_fine() {
  MatcherOptions options = matcher_preset("fine").value();
  options.hole_filling = true;
  return own_matcher("fine filled", options);
}

std::vector<QualityMatcher> matchers() {
  const QualityMatcher sgbm10 = padded(opencv_sgbm_3way(10)), dense = preset("dense", 40),
                       robust = preset("robust", 40);
  return {padded(opencv_bm_without_tests()),
          padded(opencv_sgbm_3way(0)),
          sgbm10,
          dense,
          preset("dense", 56),
          filled_fine(),
          robust,
          as_dense_as(sgbm10, robust, dense),
          preset("fine", 40)};
}

// --- disturbances

struct ImagePair {
  cv::Mat left, right;
};
using Disturbance = std::pair<const char*, ImagePair (*)(const ImagePair&)>;

cv::Mat noisy(const cv::Mat& image, std::uint64_t seed) {
  constexpr double kSigma = 3;
  cv::Mat noise(image.size(), CV_32F), sum;
  cv::RNG(seed).fill(noise, cv::RNG::NORMAL, 0, kSigma);
  cv::add(image, noise, sum, cv::noArray(), CV_8U);
  return sum;
}

ImagePair as_they_are(const ImagePair& pair) { return pair; }

ImagePair with_noise(const ImagePair& pair) { return {noisy(pair.left, 1), noisy(pair.right, 2)}; }

ImagePair with_gain(const ImagePair& pair) {
  cv::Mat darker;
  pair.right.convertTo(darker, CV_8U, 0.8, 10);
  return {pair.left, darker};
}

ImagePair lowered(const ImagePair& pair, double rows) {
  cv::Mat moved;
  const cv::Mat shift = (cv::Mat_<double>(2, 3) << 1, 0, 0, 0, 1, rows);
  cv::warpAffine(pair.right, moved, shift, pair.right.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return {pair.left, moved};
}

ImagePair with_half_a_row(const ImagePair& pair) { return lowered(pair, 0.5); }
ImagePair with_a_row(const ImagePair& pair) { return lowered(pair, 1); }

cv::Mat compressed(const cv::Mat& image) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, 70});
  return cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
}

ImagePair with_jpeg(const ImagePair& pair) { return {compressed(pair.left), compressed(pair.right)}; }

constexpr std::array<Disturbance, 6> kDisturbances{{{"none", as_they_are},
                                                    {"noise of sigma 3", with_noise},
                                                    {"right image x 0.8 + 10", with_gain},
                                                    {"right image 1/2 px lower", with_half_a_row},
                                                    {"right image 1 px lower", with_a_row},
                                                    {"JPEG of quality 70", with_jpeg}}};

// --- parts of images

/// Marks occluded pixels, which a nearer object hides from the right camera: a pixel of the row with a larger
/// disparity maps to the same right pixel.
cv::Mat1b hidden(const StereoSet& set) {
  cv::Mat1b result(set.truth.height(), set.truth.width(), std::uint8_t{0});
  for (int y = 0; y < result.rows; ++y) {
    std::vector<float> nearest(static_cast<std::size_t>(result.cols) + 1, 0.0F);  // of right pixels
    const auto match = [&](int x) {
      return static_cast<int>(std::lround(static_cast<float>(x) - set.truth.at(x, y)));
    };
    const auto known = [&](int x) { return std::isfinite(set.truth.at(x, y)) && match(x) >= 0; };
    for (int x = 0; x < result.cols; ++x) {
      if (!known(x)) continue;
      float& there = nearest[static_cast<std::size_t>(match(x))];
      there = std::max(there, set.truth.at(x, y));
    }
    for (int x = 0; x < result.cols; ++x) {
      if (!known(x)) continue;
      const auto at = static_cast<std::size_t>(match(x));
      if (std::max(nearest[at], nearest[at + 1]) > set.truth.at(x, y) + 1) result(y, x) = 1;
    }
  }
  return result;
}

/// Results over the pixels of one part of the image [%].
struct PartStats {
  double bad = 0;       ///< off by more than 1 px, or unmatched
  double too_near = 0;  ///< nearer by more than 1 px
  double matched = 0;
};

PartStats judge_part(const DisparityImage& found, int units_per_pixel, const StereoSet& set,
                     const cv::Mat1b& part, int wanted) {
  int all = 0, right = 0, near = 0, matched = 0;
  for (int y = 0; y < found.height(); ++y) {
    for (int x = 0; x < found.width(); ++x) {
      if (part(y, x) != wanted) continue;
      ++all;
      if (found.at(x, y) < 0) continue;
      ++matched;
      const double off =
          static_cast<double>(found.at(x, y)) / units_per_pixel - static_cast<double>(set.truth.at(x, y));
      if (std::abs(off) <= 1) ++right;
      if (off > 1) ++near;
    }
  }
  const double share = all == 0 ? 0 : 100.0 / all;
  return {share * (all - right), share * near, share * matched};
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

struct Shares {
  double all = 0, matched = 0, density = 0;
  void add(const Evaluation& e, double share) {
    all += share * e.bad1_known, matched += share * e.bad1_matched, density += share * e.density;
  }
  void print() const { std::printf("%8.2f%7.2f%7.1f", all, matched, density); }
};

void print_sets(const std::vector<QualityMatcher>& all, const std::vector<StereoSet>& sets) {
  print_headings("bad-1 all, matched; density", all);
  std::vector<Shares> means(all.size());
  for (const StereoSet& set : sets) {
    std::printf("%-28s", set.name.c_str());
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Evaluation e = judge(all[i], set);
      Shares shares;
      shares.add(e, 1);
      shares.print();
      means[i].add(e, 1.0 / static_cast<double>(sets.size()));
    }
    std::printf("\n");
    std::fflush(stdout);
  }
  std::printf("%-28s", "mean");
  for (const Shares& mean : means) mean.print();
  std::printf("\n");
}

void print_disturbances(const std::vector<QualityMatcher>& all, std::vector<StereoSet>& sets) {
  print_headings("disturbed, mean", all);
  for (const auto& [name, disturb] : kDisturbances) {
    std::printf("%-28s", name);
    std::vector<Shares> means(all.size());
    for (StereoSet& set : sets) {
      const ImagePair clean{set.left, set.right};
      const ImagePair disturbed = disturb(clean);
      set.left = disturbed.left, set.right = disturbed.right;
      for (std::size_t i = 0; i < all.size(); ++i) {
        means[i].add(judge(all[i], set), 1.0 / static_cast<double>(sets.size()));
      }
      set.left = clean.left, set.right = clean.right;
    }
    for (const Shares& mean : means) mean.print();
    std::printf("\n");
    std::fflush(stdout);
  }
}

void print_hidden(const std::vector<QualityMatcher>& all, const std::vector<StereoSet>& sets) {
  print_headings("hidden: bad, too near; dens.", all);
  std::printf("%-28s", "mean");
  for (const QualityMatcher& matcher : all) {
    PartStats mean;
    for (const StereoSet& set : sets) {
      const PartStats of_set =
          judge_part(matcher.match(set, set.disparities), matcher.units_per_pixel, set, hidden(set), 1);
      const double share = 1.0 / static_cast<double>(sets.size());
      mean.bad += share * of_set.bad, mean.too_near += share * of_set.too_near,
          mean.matched += share * of_set.matched;
    }
    std::printf("%8.2f%7.2f%7.1f", mean.bad, mean.too_near, mean.matched);
  }
  std::printf("\n");
}

void print_poles(const std::vector<QualityMatcher>& all) {
  print_headings("pixels on poles found, %", all);
  for (const int width : {3, 4, 6, 8}) {
    const Poles scene = poles(width);
    std::printf("%-28s", ("poles of " + std::to_string(width) + " px").c_str());
    for (const QualityMatcher& matcher : all) {
      const DisparityImage found = matcher.match(scene.set, scene.set.disparities);
      std::printf("%22.1f",
                  100 - judge_part(found, matcher.units_per_pixel, scene.set, scene.on_pole, 1).bad);
    }
    std::printf("\n");
  }
}

void print_street(const std::vector<QualityMatcher>& all) {
  print_headings("street: bad, too near; dens.", all);
  const Street scene = street();
  std::vector<DisparityImage> found;
  for (const QualityMatcher& matcher : all) found.push_back(matcher.match(scene.set, scene.set.disparities));
  for (std::size_t part = 0; part < kStreetParts.size(); ++part) {
    std::printf("%-28s", kStreetParts[part]);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const PartStats f =
          judge_part(found[i], all[i].units_per_pixel, scene.set, scene.part, static_cast<int>(part));
      std::printf("%8.2f%7.2f%7.1f", f.bad, f.too_near, f.matched);
    }
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
  if (!found.sets.empty()) print_hidden(all, found.sets);
  // Disturbed: the 18 Middlebury sets.
  std::erase_if(found.sets, [](const StereoSet& set) { return set.name.rfind("mb", 0) != 0; });
  if (!found.sets.empty()) print_disturbances(all, found.sets);
  print_poles(all);
  print_street(all);
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
