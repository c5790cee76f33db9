// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/match/evaluation.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "daemon/imagefile/pfm_file.h"
#include "daemon/imagefile/write_image.h"
#include "daemon/tools/match/match_report.h"
#include "tests/support/image_files.h"
#include "tests/support/temporary_directory.h"

namespace stereod::tools {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::infinity();

DisparityImage disparities(const std::vector<int>& values) {
  DisparityImage image(static_cast<int>(values.size()), 1);
  for (int x = 0; x < image.width(); ++x)
    image.at(x, 0) = static_cast<std::int16_t>(values[static_cast<std::size_t>(x)]);
  return image;
}

Image<float> truths(const std::vector<float>& values) {
  Image<float> image(static_cast<int>(values.size()), 1);
  for (int x = 0; x < image.width(); ++x) image.at(x, 0) = values[static_cast<std::size_t>(x)];
  return image;
}

TEST(Evaluation, SmallImage_CountsAsByHand) {
  // Errors: 0, exactly 1 (not bad), 1.5, 3, unmatched; two pixels are unknown.
  const DisparityImage found = disparities({5 * 16, 6 * 16, 6 * 16 + 8, 2 * 16, -1, 9 * 16, -1});
  const Image<float> truth = truths({5, 5, 5, 5, 4, kUnknown, kUnknown});
  const Evaluation result = evaluate(found.view(), 16, truth.view(), 2);
  EXPECT_EQ(result.known, 5);
  EXPECT_EQ(result.matched, 4);
  EXPECT_DOUBLE_EQ(result.density, 80);
  EXPECT_DOUBLE_EQ(result.bad1_known, 60);    // 1.5, 3, unmatched
  EXPECT_DOUBLE_EQ(result.bad2_known, 40);    // 3, unmatched
  EXPECT_DOUBLE_EQ(result.bad1_matched, 50);  // 1.5, 3
  EXPECT_DOUBLE_EQ(result.bad2_matched, 25);  // 3
  EXPECT_DOUBLE_EQ(result.mean_absolute_error, (0 + 1 + 1.5 + 3) / 4);
  // With 2 gray levels a pixel: 0², 2², 3², 6², and 8² for the unmatched pixel, which counts as 0.
  EXPECT_DOUBLE_EQ(result.mean_squared_difference, (0 + 4 + 9 + 36 + 64) / 5.0);
}

TEST(Evaluation, SquaredDifference_OfRounded8BitImages) {
  // 255 / 64 gray levels a pixel: 10 px is 39.8 → 40, 7.5 px is 29.9 → 30; above 64 px all is white.
  const DisparityImage found = disparities({10, 100});
  const Image<float> truth = truths({7.5F, 64});
  const Evaluation result = evaluate(found.view(), 1, truth.view(), 255.0 / 64);
  EXPECT_DOUBLE_EQ(result.mean_squared_difference, 100.0 / 2);
}

TEST(Evaluation, SignOfError_Ignored) {
  const Image<float> truth = truths({10});
  const Evaluation low = evaluate(disparities({7}).view(), 1, truth.view(), 1);
  const Evaluation high = evaluate(disparities({13}).view(), 1, truth.view(), 1);
  EXPECT_DOUBLE_EQ(low.mean_absolute_error, 3);
  EXPECT_DOUBLE_EQ(high.mean_absolute_error, 3);
  EXPECT_DOUBLE_EQ(low.bad2_known, 100);
  EXPECT_DOUBLE_EQ(high.bad2_known, 100);
}

TEST(Evaluation, NoPixels_MeansAreZero) {
  const Evaluation unknown = evaluate(disparities({3}).view(), 1, truths({kUnknown}).view(), 1);
  EXPECT_EQ(unknown.known, 0);
  EXPECT_EQ(unknown.density, 0);
  EXPECT_EQ(unknown.mean_squared_difference, 0);
  const Evaluation unmatched = evaluate(disparities({-1}).view(), 1, truths({3}).view(), 1);
  EXPECT_EQ(unmatched.bad1_known, 100);
  EXPECT_EQ(unmatched.bad1_matched, 0);
  EXPECT_EQ(unmatched.mean_absolute_error, 0);
}

TEST(Evaluation, SizesDiffer_Throws) {
  EXPECT_THROW(evaluate(disparities({1, 2}).view(), 1, truths({1}).view(), 1), std::invalid_argument);
}

TEST(GroundTruth, Image_ScaledZeroUnknown) {
  const TemporaryDirectory directory;
  Image<std::uint16_t> image(3, 1);
  image.at(1, 0) = 33;
  image.at(2, 0) = 60000;
  write_png(directory / "truth.png", image.view());
  const Image<float> truth = read_ground_truth(directory / "truth.png", 4);
  EXPECT_EQ(truth.at(0, 0), kUnknown);
  EXPECT_EQ(truth.at(1, 0), 8.25F);
  EXPECT_EQ(truth.at(2, 0), 15000.0F);
}

TEST(GroundTruth, Pfm_Unscaled) {
  const TemporaryDirectory directory;
  const Image<float> written = truths({1.25F, kUnknown, 0});
  write_pfm(directory / "truth", written.view());  // recognized by its content
  const Image<float> truth = read_ground_truth(directory / "truth", 4);
  EXPECT_EQ(truth.at(0, 0), 1.25F);
  EXPECT_EQ(truth.at(1, 0), kUnknown);
  EXPECT_EQ(truth.at(2, 0), 0.0F);
}

TEST(GroundTruth, MissingFile_Named) {
  EXPECT_EQ(file_error_of([] { read_ground_truth("/no/truth.png", 1); }),
            "/no/truth.png: the file does not exist");
}

TEST(MatchReport, Times_MedianAndMinimum) {
  EXPECT_EQ(timing_line({3, 1, 2}), "median 2.000 ms, minimum 1.000 ms\n");
  EXPECT_EQ(timing_line({4, 1, 2, 3}), "median 2.500 ms, minimum 1.000 ms\n");
  EXPECT_EQ(timing_line({0.25}), "median 0.250 ms, minimum 0.250 ms\n");
}

TEST(MatchReport, Evaluation_InTable) {
  Evaluation evaluation;
  evaluation.known = 1234;
  evaluation.matched = 1000;
  evaluation.density = 81.04;
  evaluation.bad1_known = 20.5;
  evaluation.mean_squared_difference = 1515.94;
  const std::string table = evaluation_table(evaluation, "gt.png", 3.984375);
  for (const char* part : {"against gt.png", "1234", "1000", "81.04 %", "20.50 %", "1515.9", "3.984 a px"}) {
    EXPECT_NE(table.find(part), std::string::npos) << part << " in\n" << table;
  }
}

}  // namespace
}  // namespace stereod::tools
