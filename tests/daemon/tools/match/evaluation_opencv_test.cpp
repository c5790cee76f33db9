// SPDX-License-Identifier: BSD-3-Clause
// Compares evaluate() for OpenCV's block matcher with the published results of the data sets, which another program
// computed.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <regex>
#include <stdexcept>
#include <string>

#include "daemon/tools/match/evaluation.h"

namespace stereod::tools {
namespace {

std::filesystem::path datasets() {
  if (const char* set = std::getenv("STEREO_DATASETS")) return set;
  return std::filesystem::path(STEREOD_SOURCE_DIR) / ".." / "shared" / "datasets";
}

/// Returns the first number named @p key after the first mention of @p section.
double number_in(const std::string& json, const std::string& section, const std::string& key) {
  const std::string rest = json.substr(json.find("\"" + section + "\""));
  std::smatch match;
  const std::regex number("\"" + key + "\":\\s*(-?[0-9.]+)");
  if (!std::regex_search(rest, match, number)) throw std::runtime_error("no " + key);
  return std::stod(match[1].str());
}

/// Returns the disparities of StereoBM [1/16 px], unmatched as kInvalidDisparity. OpenCV reads the images, because its PNG
/// reader rounds gray differently from cvtColor and read_gray(), and the published results used it.
DisparityImage block_match(const std::filesystem::path& directory, int disparities) {
  const cv::Mat left = cv::imread((directory / "left.png").string(), cv::IMREAD_GRAYSCALE);
  const cv::Mat right = cv::imread((directory / "right.png").string(), cv::IMREAD_GRAYSCALE);
  cv::Mat found;
  cv::StereoBM::create(disparities, 11)->compute(left, right, found);
  DisparityImage result(found.cols, found.rows);
  for (int y = 0; y < result.height(); ++y) {
    for (int x = 0; x < result.width(); ++x) {
      const std::int16_t value = found.at<std::int16_t>(y, x);
      result.at(x, y) = value < 0 ? kInvalidDisparity : value;
    }
  }
  return result;
}

class EvaluationOfOpenCv : public testing::TestWithParam<const char*> {};

TEST_P(EvaluationOfOpenCv, DataSet_AsPublished) {
  const std::filesystem::path directory = datasets() / GetParam();
  if (!std::filesystem::exists(directory / "meta.json")) {
    GTEST_SKIP() << "the data set " << GetParam() << " is not in " << datasets()
                 << "; set STEREO_DATASETS to where it is";
  }
  std::ifstream file(directory / "meta.json");
  const std::string meta{std::istreambuf_iterator<char>(file), {}};
  const Image<float> truth = read_ground_truth(directory / "gt.png", number_in(meta, "gt_scale", "gt_scale"));
  const int disparities =
      static_cast<int>(number_in(meta, "num_disparities_suggested", "num_disparities_suggested"));
  const DisparityImage found = block_match(directory, disparities);
  const Evaluation result = evaluate(found.view(), 16, truth.view(), 255.0 / disparities);

  // Half of the last digit given, rounded up.
  EXPECT_NEAR(result.bad1_known, number_in(meta, "BM11", "bad1_all"), 0.006);
  EXPECT_NEAR(result.bad2_known, number_in(meta, "BM11", "bad2_all"), 0.006);
  EXPECT_NEAR(result.bad1_matched, number_in(meta, "BM11", "bad1_m"), 0.006);
  EXPECT_NEAR(result.bad2_matched, number_in(meta, "BM11", "bad2_m"), 0.006);
  EXPECT_NEAR(result.density, number_in(meta, "BM11", "dens"), 0.006);
  EXPECT_NEAR(result.mean_absolute_error, number_in(meta, "BM11", "epe_m"), 0.0006);
  EXPECT_NEAR(result.mean_squared_difference, number_in(meta, "BM11", "mse_valid"), 0.06);
}

INSTANTIATE_TEST_SUITE_P(Middlebury, EvaluationOfOpenCv, testing::Values("mb2001_tsukuba", "mb2003_teddy"),
                         [](const auto& parameter) { return std::string(parameter.param); });

}  // namespace
}  // namespace stereod::tools
