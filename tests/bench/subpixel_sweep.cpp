// SPDX-License-Identifier: BSD-3-Clause
// Parts of a pixel against a plane whose disparity is known: our interpolation, a parabola through the same
// costs, and OpenCV's StereoBM. In the image the thin line is what an unbiased one has. Prints the errors
// and, with a file name, draws them.
//   subpixel_sweep [IMAGE.png]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "core/match/block/prefilter.h"
#include "core/match/frame_matcher.h"
#include "tests/bench/subpixel_plot.h"

namespace stereod::bench {
namespace {

constexpr int kWindow = 11;
constexpr int kCap = 31;
constexpr int kDisparities = 32;

DisparityImage match_ours(const StereoPair& pair) {
  MatcherOptions options;
  options.disparities = kDisparities;
  options.window = kWindow;
  options.prefilter_cap = kCap;
  WorkerPool pool(1);
  DisparityImage found(pair.left.size());
  FrameMatcher(options, found.size(), pool).match(pair.left.view(), pair.right.view(), found.view());
  return found;
}

DisparityImage match_opencv(const StereoPair& pair) {
  const auto mat_of = [](const GrayImage& image) {
    cv::Mat mat(image.height(), image.width(), CV_8UC1);
    for (int y = 0; y < image.height(); ++y) std::copy_n(image.row(y), image.width(), mat.ptr(y));
    return mat;
  };
  const cv::Ptr<cv::StereoBM> bm = cv::StereoBM::create(kDisparities, kWindow);
  bm->setPreFilterType(cv::StereoBM::PREFILTER_XSOBEL);
  bm->setPreFilterCap(kCap);
  bm->setUniquenessRatio(0);
  bm->setTextureThreshold(0);
  cv::Mat answer;
  bm->compute(mat_of(pair.left), mat_of(pair.right), answer);
  DisparityImage found(pair.left.size());
  for (int y = 0; y < found.height(); ++y) {
    for (int x = 0; x < found.width(); ++x) {
      const std::int16_t value = answer.at<std::int16_t>(y, x);
      found.at(x, y) = value < 0 ? kInvalidDisparity : value;
    }
  }
  return found;
}

GrayImage gradients_of(const GrayImage& gray) {
  GrayImage gradients(gray.size());
  const int last = gray.height() - 1;
  for (int y = 0; y <= last; ++y) {
    xsobel_row(gray.row(y == 0 ? 1 : y - 1), gray.row(y), gray.row(y == last ? last - 1 : y + 1),
               gray.width(), kCap, gradients.row(y));
  }
  return gradients;
}

int cost_of(const GrayImage& left, const GrayImage& right, int x, int y, int disparity) {
  int cost = 0;
  for (int v = y - kWindow / 2; v <= y + kWindow / 2; ++v) {
    for (int u = x - kWindow / 2; u <= x + kWindow / 2; ++u) {
      cost += std::abs(left.at(u, v) - right.at(u - disparity, v));
    }
  }
  return cost;
}

/// Uses our whole disparities and costs with the vertex of the parabola through the three costs.
DisparityImage match_parabola(const StereoPair& pair) {
  const GrayImage left = gradients_of(pair.left);
  const GrayImage right = gradients_of(pair.right);
  DisparityImage found(left.size());
  for (int y = 0; y < found.height(); ++y) std::fill_n(found.row(y), found.width(), kInvalidDisparity);
  // The whole number nearest to ours may be its neighbor: the minimum cost is at most one away.
  const DisparityImage ours = match_ours(pair);
  const int radius = kWindow / 2;
  for (int y = radius; y < found.height() - radius; ++y) {
    for (int x = radius + kDisparities / 2 + 2; x < found.width() - radius; ++x) {
      const int near = ours.at(x, y) / kSubpixelUnits;
      if (near < 2 || near > kDisparities / 2) continue;
      int best = near - 1;
      for (int d = near; d <= near + 1; ++d) {
        if (cost_of(left, right, x, y, d) < cost_of(left, right, x, y, best)) best = d;
      }
      const int before = cost_of(left, right, x, y, best - 1);
      const int at = cost_of(left, right, x, y, best);
      const int after = cost_of(left, right, x, y, best + 1);
      const int curve = before + after - 2 * at;
      const double offset = curve > 0 ? 0.5 * (before - after) / curve : 0;
      found.at(x, y) = static_cast<std::int16_t>(std::lround(kSubpixelUnits * (best + offset)));
    }
  }
  return found;
}

void print(const SubpixelCurve& curve) {
  const SubpixelBias& bias = curve.bias;
  std::printf("%-18s largest mean error %.3f px, rms %.3f px, whole numbers %.1f %%, answered %.1f %%\n",
              curve.name.c_str(), bias.largest_mean_error(), bias.rms_error, 100 * bias.share[0],
              100 * bias.answered);
  std::printf("  mean error (1/1000 px) by 1/16 px:");
  for (std::size_t i = 0; i < bias.mean_error.size(); i += 2)
    std::printf(" %+.0f", 1000 * bias.mean_error[i]);
  std::printf("\n  share of the answers (%%) by 1/16 px:");
  for (const double share : bias.share) std::printf(" %.1f", 100 * share);
  std::printf("\n");
}

void run(const std::string& image) {
  std::vector<SubpixelPanel> panels;
  for (const double noise : {0.0, 4.0}) {
    SubpixelSweep sweep;
    sweep.noise = noise;
    SubpixelPanel panel;
    panel.title = noise > 0 ? "noise of 4 gray levels" : "no noise";
    std::printf("%s\n", panel.title.c_str());
    for (const auto& [name, match] : {std::pair<const char*, SubpixelMatch>{"stereod", match_ours},
                                      {"parabola", match_parabola},
                                      {"OpenCV StereoBM", match_opencv}}) {
      panel.curves.push_back({name, sweep_plane(sweep, match)});
      print(panel.curves.back());
    }
    panels.push_back(panel);
  }
  if (image.empty()) return;
  if (!cv::imwrite(image, draw_subpixel(panels))) throw std::runtime_error(image + ": cannot be written");
}

}  // namespace
}  // namespace stereod::bench

int main(int argc, char** argv) {
  try {
    if (argc > 2) throw std::invalid_argument("usage: subpixel_sweep [IMAGE.png]");
    stereod::bench::run(argc == 2 ? argv[1] : "");
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "subpixel_sweep: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
