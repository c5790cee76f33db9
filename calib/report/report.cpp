#include "calib/report/report.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "calib/base/opencv_image.h"
#include "calib/quality/rectified_view.h"
#include "calib/report/html.h"
#include "calib/report/report_charts.h"
#include "calib/report/report_style.h"
#include "core/base/text.h"

namespace stereod {

namespace {

std::string jpeg_url(const GrayImage& picture) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", as_opencv(picture.view()), bytes, {cv::IMWRITE_JPEG_QUALITY, 85});
  return "data:image/jpeg;base64," + base64(bytes);
}

std::string css_class(Grade grade) {
  return grade == Grade::kGood ? "good" : grade == Grade::kUsable ? "usable" : "again";
}

std::string figure(const std::string& value, const std::string& unit, const std::string& meaning) {
  return "<div class=\"figure\"><b>" + value + "<small>" + unit + "</small></b><span>" + meaning +
         "</span></div>";
}

std::string head(const SolveResult& result, const Assessment& a) {
  std::string html = "<header class=\"" + css_class(a.verdict.grade) +
                     "\"><p>Calibration of the stereo camera</p><h1>" + in_words(a.verdict.grade) +
                     "</h1><ul>";
  for (const std::string& reason : a.verdict.reasons) html += "<li>" + escaped(reason) + "</li>";
  html += "</ul></header><section class=\"figures\">";
  html += figure(fixed(result.held_back.epipolar_error_px, 2), "px",
                 "rows apart in the rectified images, mean over the pairs, each held back once");
  html += figure(fixed(result.calibration.quality.rms_px, 2), "px",
                 "corners from where they belong, root mean square over " +
                     std::to_string(result.count(PairFate::kUsed)) + " pairs");
  html += figure(fixed(100 * std::min(a.left.share(), a.right.share()), 0), "%",
                 "of the image has seen the board, the emptier of the two");
  html += figure(length_in_words(expected_depth_error_m(result.calibration, a.depth, 2)), "",
                 "expected error of a depth of 2 m");
  return html + "</section>";
}

std::string coverage_section(const SolveResult& result, const Assessment& a) {
  const auto one = [&](const char* name, const Coverage& coverage, bool left) {
    const std::vector<std::string> empty = coverage.empty_parts();
    std::string html = "<figure>" + coverage_map(result, coverage, left) + "<figcaption><b>" + name +
                       " image</b>: " + fixed(100 * coverage.share(), 0) + " % covered";
    for (std::size_t i = 0; i < std::min<std::size_t>(empty.size(), 3); ++i) {
      html += (i == 0 ? "; little in " : ", ") + empty[i];
    }
    return html + "</figcaption></figure>";
  };
  return "<section><h2>Where the board has been</h2><p>Each dot is a corner. Hatched cells saw none; the "
         "lens "
         "is only guessed at there. Hold the board there for the next pairs.</p><div class=\"two\">" +
         one("Left", a.left, true) + one("Right", a.right, false) + "</div></section>";
}

// The pair whose row error is the median one.
const PairResult& typical_pair(const SolveResult& result, std::size_t& index) {
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < result.pairs.size(); ++i) {
    if (result.pairs[i].fate == PairFate::kUsed) used.push_back(i);
  }
  std::sort(used.begin(), used.end(), [&](std::size_t a, std::size_t b) {
    return result.pairs[a].check.epipolar_error_px < result.pairs[b].check.epipolar_error_px;
  });
  index = used[used.size() / 2];
  return result.pairs[index];
}

std::string epipolar_section(const SolveResult& result, const std::vector<ImagePair>& pictures) {
  std::size_t index = 0;
  const PairResult& pair = typical_pair(result, index);
  const Calibration& c = result.calibration;
  return "<section><h2>A rectified pair</h2><p>" + escaped(pair.name) +
         ", its corners ringed. The same corner lies on the same line in both images; while this pair was "
         "held "
         "back, they were " +
         fixed(pair.check.epipolar_error_px, 2) + " px apart.</p>" +
         epipolar_view(c, pair.corners, jpeg_url(rectified_view(c.left, pictures[index].left.view())),
                       jpeg_url(rectified_view(c.right, pictures[index].right.view()))) +
         "</section>";
}

std::string depth_section(const SolveResult& result, const Assessment& a) {
  std::string html =
      "<section><h2>How far off depth will be</h2><p>About one standard deviation, on a surface with "
      "texture: "
      "disparities are uncertain by " +
      fixed(a.depth.disparity_px, 2) + " px, " +
      (result.matched_error_px ? "as the matcher finds them on the boards while each was held back"
                               : "guessed, because the matcher found too little on the boards") +
      ", and lengths by " + fixed(100 * a.depth.scale, 2) +
      " %. A printed square of another size than was said changes all depths by the same part, and no "
      "image "
      "can tell.</p><div class=\"two\">" +
      depth_chart(result.calibration, a.depth) +
      "<table class=\"depth\"><tr><th>at</th><th>disparity</th><th>expected error</th><th></th></tr>";
  for (const double depth : kReportedDepths_m) {
    const double error = expected_depth_error_m(result.calibration, a.depth, depth);
    const Calibration& c = result.calibration;
    html += "<tr><td>" + fixed(depth, depth < 1 ? 1 : 0) + " m</td><td>" +
            fixed(c.left.projection.fx * c.baseline_m / depth, 1) + " px</td><td>± " +
            length_in_words(error) + "</td><td class=\"quiet\">" + fixed(100 * error / depth, 1) +
            " %</td></tr>";
  }
  return html + "</table></div></section>";
}

std::string pair_row(const PairResult& pair, std::size_t number, double full) {
  std::string html = "<tr class=\"" + std::string(pair.fate == PairFate::kLeftOut ? "out" : "") +
                     "\"><td class=\"quiet\">" + std::to_string(number) + "</td><td>" + escaped(pair.name) +
                     "</td>";
  if (pair.fate == PairFate::kLeftOut) {
    return html + "<td><em>left out</em></td><td colspan=\"4\">" + escaped(pair.reason) + "</td></tr>";
  }
  return html + "<td>used</td><td>" + fixed(pair.error_px, 2) + "</td><td>" +
         bar(pair.error_px, full, "used") + "</td><td>" + fixed(pair.check.epipolar_error_px, 2) +
         "</td><td>" + bar(pair.check.epipolar_error_px, full, "held") + "</td></tr>";
}

std::string pairs_section(const SolveResult& result) {
  double full = 0;
  for (const PairResult& pair : result.pairs) {
    if (pair.fate != PairFate::kLeftOut) full = std::max({full, pair.error_px, pair.check.epipolar_error_px});
  }
  std::string html =
      "<section><h2>Every pair</h2><table class=\"pairs\"><tr><th></th><th>pair</th><th>what became of "
      "it</th>"
      "<th colspan=\"2\">corners off, px</th><th colspan=\"2\">rows apart while held back, px</th></tr>";
  std::size_t number = 0;
  for (const PairResult& pair : result.pairs) html += pair_row(pair, ++number, full);
  return html + "</table></section>";
}

std::string lens_words(LensChoice lens) {
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
  const Vector3 turn = rotation_vector(pose.rotation);
  constexpr double kDegrees = 57.29577951308232;
  std::string html =
      "<section><h2>The numbers</h2><table class=\"numbers\"><tr><th></th><th>left</th><th>right</th></tr>";
  const auto row = [&](const char* name, double left, double right, int digits, const char* unit) {
    html += std::string("<tr><td>") + name + "</td><td>" + fixed(left, digits) + unit + "</td><td>" +
            fixed(right, digits) + unit + "</td></tr>";
  };
  const CameraModel &l = c.left.camera, &r = c.right.camera;
  row("focal length, across", l.fx, r.fx, 2, " px");
  row("focal length, down", l.fy, r.fy, 2, " px");
  row("principal point, x", l.cx, r.cx, 2, " px");
  row("principal point, y", l.cy, r.cy, 2, " px");
  row("this camera alone, RMS", result.left_rms_px, result.right_rms_px, 3, " px");
  html += "</table><table class=\"numbers\">";
  const auto fact = [&](const char* name, const std::string& value) {
    html += std::string("<tr><td>") + name + "</td><td>" + value + "</td></tr>";
  };
  fact("image", to_string(c.image));
  fact("lens model", lens_words(result.lens));
  fact("board", in_words(result.board) + ", squares of " + fixed(1000 * result.board.square_m, 2) + " mm");
  fact("baseline", fixed(1000 * c.baseline_m, 2) + " mm");
  fact("right camera is off by", fixed(1000 * pose.translation_m.y, 2) + " mm down, " +
                                     fixed(1000 * pose.translation_m.z, 2) + " mm forward");
  fact("and turned by", fixed(kDegrees * turn.x, 2) + "° pitch, " + fixed(kDegrees * turn.y, 2) + "° yaw, " +
                            fixed(kDegrees * turn.z, 2) + "° roll");
  fact("rectified focal length", fixed(c.left.projection.fx, 2) + " px");
  fact("calibration id", calibration_id(c));
  return html + "</table></section>";
}

}  // namespace

std::string report_page(const SolveResult& result, const Assessment& assessment,
                        const std::vector<ImagePair>& pictures) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width\"><title>Stereo calibration: " +
         in_words(assessment.verdict.grade) + "</title><style>" + std::string(kReportStyle) +
         "</style></head><body>" + std::string(kHatching) + "<main>" + head(result, assessment) +
         coverage_section(result, assessment) + epipolar_section(result, pictures) +
         depth_section(result, assessment) + pairs_section(result) + numbers_section(result) +
         "<footer>Written by stereo-calibrate.</footer></main></body></html>\n";
}

}  // namespace stereod
