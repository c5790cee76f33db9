// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pipeline/calibration_monitor.h"

#include <gtest/gtest.h>

namespace stereod {
namespace {

EpipolarStats with_error(double error_px) {
  EpipolarStats stats;
  stats.epipolar_error = EpipolarError{100, error_px, error_px, error_px, 0};
  return stats;
}

// Too few points to measure the error do not show that it is small.
TEST(CalibrationMonitor, Misaligned_UntilSmallErrorMeasured) {
  CalibrationMonitor monitor;
  EXPECT_TRUE(calibration_lost(monitor.judge(with_error(4))));
  EXPECT_TRUE(calibration_lost(monitor.judge({})));
  EXPECT_TRUE(calibration_lost(monitor.judge(with_error(0.8)))) << "above the limit to recover";
  EXPECT_FALSE(calibration_lost(monitor.judge(with_error(0.2))));
  EXPECT_FALSE(calibration_lost(monitor.judge({})));
  EXPECT_FALSE(calibration_lost(monitor.judge(with_error(0.8)))) << "below the limit";
}

// A small share that is found again does not yet clear the state.
TEST(CalibrationMonitor, NoMatches_UntilSomeFound) {
  CalibrationMonitor monitor;
  EpipolarStats stats;
  stats.searched = 300;
  const auto lost_with = [&](double found_share) {
    stats.found_share = found_share;
    return calibration_lost(monitor.judge(stats));
  };
  EXPECT_FALSE(lost_with(0.001)) << "nothing was found before either";
  stats.epipolar_error = EpipolarError{100, 0.2, 0.2, 0.3, 0};
  EXPECT_FALSE(lost_with(0.6));
  stats.epipolar_error.reset();
  stats.usual_share = 0.24;
  EXPECT_FALSE(lost_with(0.04));
  EXPECT_TRUE(lost_with(0.02));
  EXPECT_TRUE(lost_with(0.07));
  stats.searched = 50;
  EXPECT_TRUE(lost_with(0.6)) << "too few points";
  stats.searched = 300;
  EXPECT_FALSE(lost_with(0.2));
  EXPECT_FALSE(lost_with(0.05));
}

TEST(CalibrationMonitor, Message_NamesValueLimitAndRemedy) {
  EXPECT_EQ(describe(CalibrationFit::kMisaligned, with_error(4.12)),
            "epipolar error 4.1 px (limit 1 px): the cameras have moved relative to each other. Run "
            "'stereo-calibrate check --daemon' to measure it, and calibrate again if it confirms the error");
  EXPECT_EQ(describe(CalibrationFit::kMisaligned, with_error(0.8))
                .rfind("epipolar error 0.8 px (limit 0.7 px): ", 0),
            0U);
  EXPECT_EQ(describe(CalibrationFit::kMisaligned, {}).rfind("epipolar error above 1 px (too few points", 0),
            0U);
  EpipolarStats stats;
  stats.found_share = 0.02;
  stats.usual_share = 0.6;
  EXPECT_EQ(
      describe(CalibrationFit::kNoMatches, stats)
          .rfind("only 2 % of the points of the left image found in the right image (usually 60 %): a lens",
                 0),
      0U);
}

}  // namespace
}  // namespace stereod
