// SPDX-License-Identifier: BSD-3-Clause
#include "calib/solve/camera_solver.h"

#include <opencv2/calib3d.hpp>
#include <optional>
#include <string>
#include <utility>

#include "calib/base/errors.h"

namespace stereod::calib {

namespace {

using ObjectPoints = std::vector<cv::Point3d>;
using ImagePoints = std::vector<cv::Point2d>;

ObjectPoints points_of(const Board& board) {
  ObjectPoints points;
  for (std::size_t i = 0; i < board.corner_count(); ++i) {
    const Vector3 p = board_point(board, i);
    points.emplace_back(p.x, p.y, p.z);
  }
  return points;
}

ImagePoints points_of(const Corners& corners) {
  ImagePoints points;
  for (const Point2& p : corners) points.emplace_back(p.x, p.y);
  return points;
}

// cv::calibrateCamera() and cv::stereoCalibrate() need single precision.
std::vector<std::vector<cv::Point3f>> single_precision(const std::vector<ObjectPoints>& lists) {
  std::vector<std::vector<cv::Point3f>> result;
  result.reserve(lists.size());
  for (const ObjectPoints& list : lists) result.emplace_back(list.begin(), list.end());
  return result;
}
std::vector<std::vector<cv::Point2f>> single_precision(const std::vector<ImagePoints>& lists) {
  std::vector<std::vector<cv::Point2f>> result;
  result.reserve(lists.size());
  for (const ImagePoints& list : lists) result.emplace_back(list.begin(), list.end());
  return result;
}

int pinhole_flags(LensChoice lens) {
  switch (lens) {
    case LensChoice::kTilted:
      return cv::CALIB_RATIONAL_MODEL | cv::CALIB_THIN_PRISM_MODEL | cv::CALIB_TILTED_MODEL;
    case LensChoice::kThinPrism:
      return cv::CALIB_RATIONAL_MODEL | cv::CALIB_THIN_PRISM_MODEL;
    case LensChoice::kRational:
      return cv::CALIB_RATIONAL_MODEL;
    default:
      return 0;
  }
}

std::size_t coefficient_count(LensChoice lens) {
  switch (lens) {
    case LensChoice::kPinhole:
      return 5;
    case LensChoice::kRational:
      return 8;
    case LensChoice::kThinPrism:
      return 12;
    case LensChoice::kTilted:
      return 14;
    case LensChoice::kFisheye:
      return 4;
  }
  return 5;
}

cv::TermCriteria until_converged() { return {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 200, 1e-9}; }

cv::Mat matrix_of(const CameraModel& m) {
  return (cv::Mat_<double>(3, 3) << m.fx, 0, m.cx, 0, m.fy, m.cy, 0, 0, 1);
}

CameraModel model_of(Size image, const cv::Mat& matrix, const cv::Mat& lens, LensChoice choice) {
  CameraModel m{image, matrix.at<double>(0, 0), matrix.at<double>(1, 1), matrix.at<double>(0, 2),
                matrix.at<double>(1, 2)};
  m.lens = choice == LensChoice::kFisheye ? LensModel::kFisheye : LensModel::kPinhole;
  std::vector<double> coefficients = lens.reshape(1, 1);
  coefficients.resize(coefficient_count(choice));
  set_distortion(m, coefficients);
  return m;
}

Matrix3 matrix3_of(const cv::Matx33d& m) {
  Matrix3 result;
  for (std::size_t i = 0; i < 9; ++i) result.m[i] = m.val[i];
  return result;
}

[[noreturn]] void fail(const std::string& what) {
  throw CalibrationError(
      "cannot solve for " + what +
      " from these images; take more pairs, with the board tilted in different directions, near "
      "and far, in every part of the image");
}

}  // namespace

std::optional<LensChoice> parse_lens(std::string_view name) {
  if (name == "pinhole") return LensChoice::kPinhole;
  if (name == "rational") return LensChoice::kRational;
  if (name == "thin-prism") return LensChoice::kThinPrism;
  if (name == "tilted") return LensChoice::kTilted;
  if (name == "fisheye") return LensChoice::kFisheye;
  return std::nullopt;
}

CameraSolution solve_camera(Size image, const Board& board, std::span<const Corners> views, LensChoice lens) {
  std::vector<ImagePoints> seen;
  for (const Corners& corners : views) seen.push_back(points_of(corners));
  const std::vector<ObjectPoints> boards(seen.size(), points_of(board));
  cv::Mat matrix, distortion;
  std::vector<cv::Mat> rotations, translations;
  const cv::Size size(image.width, image.height);
  CameraSolution solution;
  try {
    if (lens == LensChoice::kFisheye) {
      const int flags = cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW;
      solution.rms_px = cv::fisheye::calibrate(boards, seen, size, matrix, distortion, rotations,
                                               translations, flags, until_converged());
    } else {
      solution.rms_px =
          cv::calibrateCamera(single_precision(boards), single_precision(seen), size, matrix, distortion,
                              rotations, translations, pinhole_flags(lens), until_converged());
    }
  } catch (const cv::Exception&) {
    fail("the camera parameters");
  }
  if (!cv::checkRange(matrix) || !cv::checkRange(distortion)) fail("the camera parameters");
  solution.camera = model_of(image, matrix, distortion, lens);
  return solution;
}

StereoSolution solve_stereo(const Board& board, std::span<const BoardPair> pairs, const CameraModel& left,
                            const CameraModel& right, LensChoice lens) {
  std::vector<ImagePoints> seen_left, seen_right;
  for (const BoardPair& pair : pairs) {
    seen_left.push_back(points_of(pair.left));
    seen_right.push_back(points_of(pair.right));
  }
  const std::vector<ObjectPoints> boards(pairs.size(), points_of(board));
  cv::Mat matrix_left = matrix_of(left), matrix_right = matrix_of(right);
  cv::Mat lens_left(distortion_of(left), true), lens_right(distortion_of(right), true);
  lens_left.resize(coefficient_count(lens), cv::Scalar(0));
  lens_right.resize(coefficient_count(lens), cv::Scalar(0));
  cv::Mat rotation, translation, essential, fundamental;
  const cv::Size size(left.image.width, left.image.height);
  StereoSolution solution;
  try {
    if (lens == LensChoice::kFisheye) {
      const int flags = cv::fisheye::CALIB_USE_INTRINSIC_GUESS | cv::fisheye::CALIB_FIX_SKEW;
      solution.rms_px =
          cv::fisheye::stereoCalibrate(boards, seen_left, seen_right, matrix_left, lens_left, matrix_right,
                                       lens_right, size, rotation, translation, flags, until_converged());
    } else {
      const int flags = cv::CALIB_USE_INTRINSIC_GUESS | pinhole_flags(lens);
      solution.rms_px =
          cv::stereoCalibrate(single_precision(boards), single_precision(seen_left),
                              single_precision(seen_right), matrix_left, lens_left, matrix_right, lens_right,
                              size, rotation, translation, essential, fundamental, flags, until_converged());
    }
  } catch (const cv::Exception&) {
    fail("the relative pose of the cameras");
  }
  if (!cv::checkRange(matrix_left) || !cv::checkRange(matrix_right) || !cv::checkRange(translation)) {
    fail("the relative pose of the cameras");
  }
  solution.cameras.left = model_of(left.image, matrix_left, lens_left, lens);
  solution.cameras.right = model_of(right.image, matrix_right, lens_right, lens);
  solution.cameras.pose.rotation = matrix3_of(cv::Matx33d(rotation));
  solution.cameras.pose.translation_m = {translation.at<double>(0), translation.at<double>(1),
                                         translation.at<double>(2)};
  return solution;
}

BoardPose solve_pose(const CameraModel& camera, const Board& board, const Corners& corners) {
  ObjectPoints object;
  ImagePoints seen;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto undistorted = camera.undistort(camera.from_pixel(corners[i]));
    if (!undistorted) continue;
    const Vector3 p = board_point(board, i);
    object.emplace_back(p.x, p.y, p.z);
    seen.emplace_back(undistorted->x, undistorted->y);
  }
  if (object.size() < 6) fail("the pose of the board");
  cv::Vec3d rotation_vector, translation;
  cv::Matx33d rotation;
  try {
    if (!cv::solvePnP(object, seen, cv::Matx33d::eye(), cv::noArray(), rotation_vector, translation)) {
      fail("the pose of the board");
    }
    cv::Rodrigues(rotation_vector, rotation);
  } catch (const cv::Exception&) {
    fail("the pose of the board");
  }
  return {matrix3_of(rotation), {translation[0], translation[1], translation[2]}};
}

}  // namespace stereod::calib
