// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/config/calibration_file.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

namespace stereod {
namespace {

namespace fs = std::filesystem;

// A directory of the test's own, gone when the test is.
class CalibrationFile : public testing::Test {
 public:
  CalibrationFile() {
    std::string name = (fs::temp_directory_path() / "stereod-calibration-XXXXXX").string();
    directory_ = ::mkdtemp(name.data());
    file_ = directory_ / "calibration.yaml";
  }
  ~CalibrationFile() override { fs::remove_all(directory_); }

 protected:
  // The complaint about a file of this text, without the directory.
  std::string complaint_about(const std::string& text) const {
    std::ofstream(file_, std::ios::binary) << text;
    return complaint_of(file_);
  }
  std::string complaint_of(const fs::path& file) const {
    try {
      read_calibration(file);
    } catch (const FileError& error) {
      std::string sentence = error.what();
      const std::string prefix = directory_.string() + "/";
      if (sentence.starts_with(prefix)) sentence.erase(0, prefix.size());
      return sentence;
    }
    return "none";
  }
  std::size_t files_in_directory() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(directory_), fs::directory_iterator()));
  }

  fs::path directory_;
  fs::path file_;
};

Calibration sound() {
  CameraCalibration left;
  left.camera = {{640, 480}, 551.2345678901234, 548, 325.1, 236.7};
  left.camera.k1 = -0.28, left.camera.k2 = 1.0 / 3, left.camera.p1 = 1e-17, left.camera.p2 = -6.02e-5;
  left.camera.k3 = 4.9e-324, left.camera.k4 = 0.1, left.camera.k5 = -0.0, left.camera.k6 = 12345678.9;
  left.rotation = rotation_about({0.01, -0.02, 0.005});
  left.projection = {520.1, 521.3, 320, 240};
  CameraCalibration right = left;
  right.camera.fx = 555;
  right.rotation = rotation_about({-0.01, 0.015, 1e-9});
  right.projection.cx = 333.125;
  Calibration calibration{{640, 480}, left, right, 0.0601, "", {12, 0.31, 0.2}};
  calibration.id = calibration_id(calibration);
  return calibration;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("the file does not contain " + from);
  return text.replace(at, from.size(), to);
}

// "calibration.yaml:7" for the line in which `word` first stands.
std::string place_of(const std::string& text, const std::string& word) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(text.find(word));
  return "calibration.yaml:" + std::to_string(std::count(text.begin(), end, '\n') + 1) + ": ";
}

TEST_F(CalibrationFile, Written_ReadsBackToTheBit) {
  write_calibration(file_, sound());
  EXPECT_EQ(read_calibration(file_), sound());
  EXPECT_EQ(files_in_directory(), 1U);

  std::mt19937_64 random(5);
  for (int round = 0; round < 100; ++round) {
    Calibration calibration = sound();
    const auto number = [&](double reach) {
      return std::uniform_real_distribution<double>(-reach, reach)(random);
    };
    calibration.right.camera.k1 = number(1), calibration.right.camera.k2 = number(1e-3);
    calibration.right.camera.cx = number(1000), calibration.baseline_m = 0.06 + number(0.05);
    calibration.left.rotation = rotation_about({number(1), number(1), number(1)});
    calibration.quality.rms_px = 1 + number(1);
    calibration.id = calibration_id(calibration);
    write_calibration(file_, calibration);
    ASSERT_EQ(read_calibration(file_), calibration);
  }
}

TEST_F(CalibrationFile, EveryLensModel_ReadsBack) {
  Calibration calibration = sound();
  CameraModel& left = calibration.left.camera;
  for (double* coefficient : {&left.s1, &left.s2, &left.s3, &left.s4, &left.tau_x, &left.tau_y}) {
    *coefficient = -0.01 / 3;
    calibration.id = calibration_id(calibration);
    write_calibration(file_, calibration);
    ASSERT_EQ(read_calibration(file_), calibration);
  }
  CameraModel fisheye{{640, 480}, 300, 301, 320, 240};
  fisheye.lens = LensModel::kFisheye;
  fisheye.k1 = 0.1 / 3, fisheye.k2 = -0.01, fisheye.k3 = 1e-5, fisheye.k4 = -1.0 / 7;
  calibration.left.camera = calibration.right.camera = fisheye;
  calibration.id = calibration_id(calibration);
  write_calibration(file_, calibration);
  EXPECT_EQ(read_calibration(file_), calibration);

  const std::string five = "model: fisheye\n  fx: 300";
  EXPECT_NE(calibration_text(calibration).find(five), std::string::npos);
  EXPECT_TRUE(complaint_about(replaced(calibration_text(calibration), "distortion: [", "distortion: [1, "))
                  .ends_with("left.distortion: found 5 values, allowed a list of numbers (4)"));
}

TEST_F(CalibrationFile, EditedFile_HasAnotherId) {
  const std::string text = calibration_text(sound());
  EXPECT_EQ(complaint_about(replaced(text, "fx: 555 ", "fx: 556 ")), "none");
  EXPECT_NE(read_calibration(file_).id, sound().id);
  EXPECT_EQ(complaint_about(replaced(text, "id: '" + sound().id + "'", "id: edited")), "none");
  EXPECT_EQ(read_calibration(file_).id, sound().id);
}

TEST_F(CalibrationFile, Mistake_NamedWithLineAndKey) {
  const std::string good = calibration_text(sound());
  struct Case {
    std::string from, to, place, sentence;
  };
  const std::vector<Case> cases = {
      {"baseline_m: 0.0601", "baselin_m: 0.0601", "", "baseline_m: is missing"},
      {"image_width: 640", "image_width: 640.5", "image_width",
       "image_width: found 640.5, allowed 1…16384 (whole numbers)"},
      {"image_width: 640", "image_width: 0", "image_width", "image_width: found 0, allowed 1…16384"},
      {"baseline_m: 0.0601", "baseline_m: 60.1cm", "baseline_m",
       "baseline_m: found '60.1cm', allowed 0.0001…100"},
      {"baseline_m: 0.0601", "baseline_m: -0.06", "baseline_m",
       "baseline_m: found -0.06, allowed 0.0001…100"},
      {"model: pinhole", "model: fishy", "  model", "left.model: found 'fishy', allowed pinhole, fisheye"},
      {"fy: 548", "fy: nan", "  fy", "left.fy: found 'nan', allowed 1…1000000"},
      {"-0.28, ", "", "  distortion",
       "left.distortion: found 7 values, allowed a list of numbers (4, 5, 8, 12, 14)"},
      {"-0.28, ", "much, ", "  distortion", "left.distortion: found 'much', allowed finite numbers"},
      {"projection:", "projektion:", "", "left.projection: is missing"},
      {"  rms_px: 0.31", "  rms_px: 0.31\n  rms: 1", "  rms: 1",
       "quality.rms: is not a known key; the nearest known key is 'rms_px'"},
      {"image_height: 480", "image_height: 480\nbaseline: 6", "baseline: 6",
       "baseline: is not a known key; the nearest known key is 'baseline_m'"},
  };
  for (const Case& each : cases) {
    const std::string text = replaced(good, each.from, each.to);
    const std::string complaint = complaint_about(text);
    const std::string place = each.place.empty() ? "calibration.yaml" : place_of(text, each.place);
    EXPECT_TRUE(complaint.starts_with(place)) << complaint << "\nshould begin with " << place;
    EXPECT_TRUE(complaint.ends_with(": " + each.sentence))
        << complaint << "\nshould end with " << each.sentence;
  }
}

TEST_F(CalibrationFile, InconsistentNumbers_Named) {
  const std::string good = calibration_text(sound());
  EXPECT_EQ(complaint_about(replaced(good, "fy: 521.3", "fy: 520")),
            "calibration.yaml: the projections' fy differ (left 520, right 521.3), so the rows of the "
            "rectified images "
            "do not align");
  EXPECT_EQ(complaint_about(replaced(good, "rotation: [0.9", "rotation: [0.8")),
            "calibration.yaml: the left camera's rotation is not one: its rows must be orthonormal to "
            "0.000001 and its "
            "determinant +1");
}

TEST_F(CalibrationFile, NoCalibration_Refused) {
  EXPECT_EQ(complaint_of(directory_ / "none.yaml"), "none.yaml: the file does not exist");
  EXPECT_NE(complaint_of(directory_), "none");
  const std::string broken = complaint_about("image_width: 640\nleft: [1, 2\nright: }\n");
  EXPECT_TRUE(broken.starts_with("calibration.yaml:3: not valid YAML: ")) << broken;
  for (const char* text : {"", "# only a comment\n", "just words\n", "- a\n- list\n"}) {
    const std::string complaint = complaint_about(text);
    EXPECT_TRUE(complaint.starts_with("calibration.yaml:1: found ")) << complaint;
  }
}

// A file cut short or with changed bytes gives a calibration or a FileError.
TEST_F(CalibrationFile, DamagedFile_Refused) {
  const std::string good = calibration_text(sound());
  std::mt19937 random(3);
  int refused = 0;
  for (int round = 0; round < 300; ++round) {
    std::string text = good.substr(0, random() % good.size());
    for (int change = 0; change < round % 3 && !text.empty(); ++change) {
      text[random() % text.size()] = static_cast<char>(random());
    }
    refused += complaint_about(text) != "none" ? 1 : 0;
  }
  EXPECT_GT(refused, 280);
}

TEST_F(CalibrationFile, FailedWrite_KeepsTheOldFile) {
  write_calibration(file_, sound());
  Calibration unsound = sound();
  unsound.baseline_m = -1;
  EXPECT_THROW(write_calibration(file_, unsound), FileError);
  Calibration unreadable = sound();  // sound, but not what the reader lets pass
  unreadable.baseline_m = 1000;
  EXPECT_THROW(write_calibration(file_, unreadable), FileError);
  EXPECT_EQ(read_calibration(file_), sound());
  EXPECT_EQ(files_in_directory(), 1U);

  fs::create_directory(directory_ / "taken");
  EXPECT_THROW(write_calibration(directory_ / "taken", sound()), FileError);
  EXPECT_EQ(files_in_directory(), 2U);
  EXPECT_THROW(write_calibration(directory_ / "missing" / "calibration.yaml", sound()), FileError);
}

TEST_F(CalibrationFile, NewFile_ReadableByOthers) {
  write_calibration(file_, sound());
  EXPECT_EQ(fs::status(file_).permissions(), fs::perms(0644));
}

}  // namespace
}  // namespace stereod
