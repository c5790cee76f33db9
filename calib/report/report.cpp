// SPDX-License-Identifier: BSD-3-Clause
#include "calib/report/report.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "calib/base/opencv_image.h"
#include "calib/base/text.h"
#include "calib/quality/rectified_view.h"
#include "calib/report/report_charts.h"
#include "calib/report/report_style.h"

namespace stereod::calib {

namespace {

std::string jpeg_url(const GrayImage& image) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", as_opencv(image.view()), bytes, {cv::IMWRITE_JPEG_QUALITY, 85});
  return "data:image/jpeg;base64," + base64(bytes);
}

std::string css_class(Grade grade) {
  return grade == Grade::kGood ? "good" : grade == Grade::kUsable ? "usable" : "again";
}

std::string stat(const std::string& value, const std::string& unit, const std::string& meaning) {
  return "<div class=\"stat\"><b>" + value + "<small>" + unit + "</small></b><span>" + meaning +
         "</span></div>";
}

std::string head(const SolveResult& result, const Assessment& a) {
  std::string html = "<header class=\"" + css_class(a.verdict.grade) +
                     "\"><p>Calibration of the stereo camera</p><h1>" + to_string(a.verdict.grade) +
                     "</h1><ul>";
  for (const std::string& reason : a.verdict.reasons) html += "<li>" + escape_html(reason) + "</li>";
  html += "</ul></header><section class=\"stats\">";
  html +=
      stat(fixed(result.held_out.epipolar_error_px, 2), "px",
           "epipolar error: row difference of corners in the rectified images, mean over the held-out pairs");
  html += stat(fixed(result.calibration.quality.rms_px, 2), "px",
               "reprojection error of the corners, RMS over " +
                   std::to_string(result.count(PairOutcome::kUsed)) + " pairs");
  html += stat(fixed(100 * std::min(a.left.share(), a.right.share()), 0), "%",
               "of the image covered by the board; the smaller share of the two images");
  html += stat(format_length(expected_depth_error_m(result.calibration, a.depth, 2)), "",
               "expected depth error at 2 m");
  return html + "</section>";
}

std::string coverage_section(const SolveResult& result, const Assessment& a) {
  const auto one = [&](const char* name, const Coverage& coverage, bool left) {
    const std::vector<std::string> empty = coverage.empty_parts();
    std::string html = "<figure>" + coverage_map(result, coverage, left) + "<figcaption><b>" + name +
                       " image</b>: " + fixed(100 * coverage.share(), 0) + " % covered";
    for (std::size_t i = 0; i < std::min<std::size_t>(empty.size(), 3); ++i) {
      html += (i == 0 ? "; too little of " : ", ") + empty[i];
    }
    return html + "</figcaption></figure>";
  };
  return "<section><h2>Coverage</h2><p>Each dot is a corner. Hatched cells have none: the distortion is "
         "extrapolated there. Hold the board there for the next pairs.</p><div class=\"two\">" +
         one("Left", a.left, true) + one("Right", a.right, false) + "</div></section>";
}

// Returns the used pair with the median epipolar error.
const PairResult& typical_pair(const SolveResult& result, std::size_t& index) {
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < result.pairs.size(); ++i) {
    if (result.pairs[i].outcome == PairOutcome::kUsed) used.push_back(i);
  }
  std::sort(used.begin(), used.end(), [&](std::size_t a, std::size_t b) {
    return result.pairs[a].check.epipolar_error_px < result.pairs[b].check.epipolar_error_px;
  });
  index = used[used.size() / 2];
  return result.pairs[index];
}

std::string epipolar_section(const SolveResult& result, const std::vector<ImagePair>& images) {
  std::size_t index = 0;
  const PairResult& pair = typical_pair(result, index);
  const Calibration& c = result.calibration;
  return "<section><h2>A rectified pair</h2><p>" + escape_html(pair.name) +
         ", corners circled. A corner should lie on the same line in both images. Epipolar error while this pair "
         "was held out: " +
         fixed(pair.check.epipolar_error_px, 2) + " px.</p>" +
         epipolar_view(c, pair.corners, jpeg_url(rectified_view(c.left, images[index].left.view())),
                       jpeg_url(rectified_view(c.right, images[index].right.view()))) +
         "</section>";
}

std::string depth_section(const SolveResult& result, const Assessment& a) {
  std::string html =
      "<section><h2>Expected depth error</h2><p>One standard deviation, on a textured surface. Disparity "
      "error " +
      fixed(a.depth.disparity_px, 2) + " px, " +
      (result.matched_error_px ? "measured with the matcher on the boards of held-out pairs"
                               : "estimated, because the matcher found too few disparities on the boards") +
      "; error of scale " + fixed(100 * a.depth.scale, 2) +
      " %. If the printed square has another size than given, all depths change by the same factor; images "
      "cannot show this.</p><div class=\"two\">" +
      depth_chart(result.calibration, a.depth) +
      "<table class=\"depth\"><tr><th>depth</th><th>disparity</th><th>expected error</th><th></th></tr>";
  for (const double depth : kReportedDepths_m) {
    const double error = expected_depth_error_m(result.calibration, a.depth, depth);
    const Calibration& c = result.calibration;
    html += "<tr><td>" + fixed(depth, depth < 1 ? 1 : 0) + " m</td><td>" +
            fixed(c.left.projection.fx * c.baseline_m / depth, 1) + " px</td><td>± " + format_length(error) +
            "</td><td class=\"quiet\">" + fixed(100 * error / depth, 1) + " %</td></tr>";
  }
  return html + "</table></div></section>";
}

std::string pair_row(const PairResult& pair, std::size_t number, double full) {
  std::string html = "<tr class=\"" + std::string(pair.outcome == PairOutcome::kRejected ? "out" : "") +
                     "\"><td class=\"quiet\">" + std::to_string(number) + "</td><td>" +
                     escape_html(pair.name) + "</td>";
  if (pair.outcome == PairOutcome::kRejected) {
    return html + "<td><em>rejected</em></td><td colspan=\"4\">" + escape_html(pair.reason) + "</td></tr>";
  }
  return html + "<td>used</td><td>" + fixed(pair.error_px, 2) + "</td><td>" +
         bar(pair.error_px, full, "used") + "</td><td>" + fixed(pair.check.epipolar_error_px, 2) +
         "</td><td>" + bar(pair.check.epipolar_error_px, full, "held") + "</td></tr>";
}

std::string pairs_section(const SolveResult& result) {
  double full = 0;
  for (const PairResult& pair : result.pairs) {
    if (pair.outcome != PairOutcome::kRejected)
      full = std::max({full, pair.error_px, pair.check.epipolar_error_px});
  }
  std::string html =
      "<section><h2>All pairs</h2><table class=\"pairs\"><tr><th></th><th>pair</th><th>outcome</th>"
      "<th colspan=\"2\">reprojection error, px</th><th colspan=\"2\">epipolar error held out, px</th></tr>";
  std::size_t number = 0;
  for (const PairResult& pair : result.pairs) html += pair_row(pair, ++number, full);
  return html + "</table></section>";
}

std::string lens_name(LensChoice lens) {
  switch (lens) {
    case LensChoice::kPinhole:
      return "pinhole, 5 coefficients";
    case LensChoice::kRational:
      return "pinhole, rational, 8 coefficients";
    case LensChoice::kThinPrism:
      return "pinhole, thin prism, 12 coefficients";
    case LensChoice::kTilted:
      return "pinhole, tilted sensor, 14 coefficients";
    case LensChoice::kFisheye:
      return "fisheye, equidistant";
  }
  return "";
}

std::string numbers_section(const SolveResult& result) {
  const Calibration& c = result.calibration;
  const StereoPose pose = stereo_pose(c);
  const Vector3 rotation = rotation_vector(pose.rotation);
  constexpr double kDegrees = 57.29577951308232;
  std::string html =
      "<section><h2>Parameters</h2><table class=\"numbers\"><tr><th></th><th>left</th><th>right</th></tr>";
  const auto row = [&](const char* name, double left, double right, int digits, const char* unit) {
    html += std::string("<tr><td>") + name + "</td><td>" + fixed(left, digits) + unit + "</td><td>" +
            fixed(right, digits) + unit + "</td></tr>";
  };
  const CameraModel &l = c.left.camera, &r = c.right.camera;
  row("focal length fx", l.fx, r.fx, 2, " px");
  row("focal length fy", l.fy, r.fy, 2, " px");
  row("principal point cx", l.cx, r.cx, 2, " px");
  row("principal point cy", l.cy, r.cy, 2, " px");
  row("reprojection error of this camera alone, RMS", result.left_rms_px, result.right_rms_px, 3, " px");
  html += "</table><table class=\"numbers\">";
  const auto entry = [&](const char* name, const std::string& value) {
    html += std::string("<tr><td>") + name + "</td><td>" + value + "</td></tr>";
  };
  entry("image", std::to_string(c.image.width) + "×" + std::to_string(c.image.height));
  entry("lens model", lens_name(result.lens));
  entry("board", to_string(result.board) + ", squares of " + fixed(1000 * result.board.square_m, 2) + " mm");
  entry("baseline", fixed(1000 * c.baseline_m, 2) + " mm");
  entry("right camera offset", fixed(1000 * pose.translation_m.y, 2) + " mm down, " +
                                   fixed(1000 * pose.translation_m.z, 2) + " mm forward");
  entry("right camera rotation", fixed(kDegrees * rotation.x, 2) + "° pitch, " +
                                     fixed(kDegrees * rotation.y, 2) + "° yaw, " +
                                     fixed(kDegrees * rotation.z, 2) + "° roll");
  entry("rectified focal length", fixed(c.left.projection.fx, 2) + " px");
  entry("calibration id", calibration_id(c));
  return html + "</table></section>";
}

}  // namespace

std::string report_page(const SolveResult& result, const Assessment& assessment,
                        const std::vector<ImagePair>& images) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width\"><title>Stereo calibration: " +
         to_string(assessment.verdict.grade) + "</title><style>" + std::string(kReportStyle) +
         "</style></head><body>" + std::string(kHatching) + "<main>" + head(result, assessment) +
         coverage_section(result, assessment) + epipolar_section(result, images) +
         depth_section(result, assessment) + pairs_section(result) + numbers_section(result) +
         "<footer>Written by stereo-calibrate.</footer></main></body></html>\n";
}

}  // namespace stereod::calib
