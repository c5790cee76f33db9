// SPDX-License-Identifier: BSD-3-Clause
// stereo-match: runs the matcher of stereod on two image files.
#include <chrono>
#include <cstdio>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/text.h"
#include "core/base/worker_pool.h"
#include "core/geometry/depth.h"
#include "core/geometry/stereo_rectification.h"
#include "core/match/frame_matcher.h"
#include "core/rectify/rectify_map.h"
#include "daemon/base/file_error.h"
#include "daemon/config/calibration_file.h"
#include "daemon/imagefile/disparity_file.h"
#include "daemon/imagefile/read_image.h"
#include "daemon/imagefile/write_image.h"
#include "daemon/tools/match/evaluation.h"
#include "daemon/tools/match/match_arguments.h"
#include "daemon/tools/match/match_report.h"
#include "daemon/visual/disparity_rendering.h"

namespace stereod::tools {
namespace {

constexpr int kBadInput = 2;
constexpr int kFailure = 1;

struct InputImage {
  GrayImage image;
  std::optional<ValidityMask> mask;  ///< empty unless rectified
};

struct Pair {
  InputImage left, right;
};

/// @p verb: "has" or "is for".
void require_size(const std::filesystem::path& file, const char* verb, Size found,
                  const std::filesystem::path& reference, Size wanted) {
  if (found == wanted) return;
  throw FileError(file.string() + ": " + verb + " " + to_string(found) + " pixels, but " +
                  reference.string() + " has " + to_string(wanted) + "; the sizes must be equal");
}

InputImage rectified(const GrayImage& source, const CameraCalibration& calibration,
                     Interpolation interpolation, WorkerPool& pool) {
  const RectifyMap map(calibration, {source.size(), source.view().stride(), 1}, interpolation);
  InputImage result{GrayImage(source.size()), map.mask()};
  rectify_gray(map, source.row(0), result.image.view(), pool);
  return result;
}

Pair read_pair(const MatchArguments& arguments, const std::optional<Calibration>& calibration,
               WorkerPool& pool) {
  GrayImage left = read_gray(arguments.left);
  GrayImage right = read_gray(arguments.right);
  require_size(arguments.right, "has", right.size(), arguments.left, left.size());
  if (!calibration) return {{std::move(left), {}}, {std::move(right), {}}};
  require_size(*arguments.calibration, "is for", calibration->image, arguments.left, left.size());
  const Interpolation interpolation = arguments.rectify.interpolation;
  return {rectified(left, calibration->left, interpolation, pool),
          rectified(right, calibration->right, interpolation, pool)};
}

std::vector<double> measure(FrameMatcher& matcher, const Pair& pair, DisparityImage& disparity, int runs) {
  std::vector<double> times_ms;
  for (int run = 0; run < runs; ++run) {
    const auto start = std::chrono::steady_clock::now();
    matcher.match(pair.left.image.view(), pair.right.image.view(), disparity.view());
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    times_ms.push_back(time.count());
  }
  return times_ms;
}

void write_view(const MatchArguments& arguments, const DisparityImage& disparity,
                const std::optional<Calibration>& calibration) {
  DisparityRenderingOptions options;
  if (calibration) {
    options.depth = DepthScale{calibration->left.projection.fx * calibration->baseline_m,
                               disparity_offset_px(*calibration)};
  }
  const ColorImage image = draw_disparity(disparity.view(), arguments.matcher.units_per_pixel(), options);
  write_png(*arguments.color, image.view());
}

/// Converts filled pixels to plain disparities. Returns a line with their number, because the files cannot mark them.
std::string include_filled(DisparityImage& disparity) {
  long measured = 0, filled = 0;
  for (int y = 0; y < disparity.height(); ++y) {
    for (int x = 0; x < disparity.width(); ++x) {
      std::int16_t& value = disparity.at(x, y);
      if (is_filled(value)) {
        value = filled_disparity(value), ++filled;
      } else if (value >= 0) {
        ++measured;
      }
    }
  }
  return filled_line(measured, filled, static_cast<long>(disparity.width()) * disparity.height());
}

void print_comparison(const MatchArguments& arguments, const DisparityImage& disparity,
                      const Image<float>& truth, const std::string& title) {
  const double gray_per_px = 255.0 / (arguments.matcher.min_disparity + arguments.matcher.disparities);
  const Evaluation evaluation =
      evaluate(disparity.view(), arguments.matcher.units_per_pixel(), truth.view(), gray_per_px);
  std::fputs(evaluation_table(evaluation, title, gray_per_px).c_str(), stdout);
}

void run(const MatchArguments& arguments) {
  std::optional<Calibration> calibration;
  if (arguments.calibration) calibration = read_calibration(*arguments.calibration);
  if (calibration && arguments.rectify.alpha)
    calibration = with_alpha(*calibration, *arguments.rectify.alpha);
  WorkerPool pool(arguments.threads);
  const Pair pair = read_pair(arguments, calibration, pool);
  std::optional<Image<float>> truth;
  if (arguments.ground_truth) {
    truth = read_ground_truth(*arguments.ground_truth, arguments.ground_truth_scale);
    require_size(*arguments.ground_truth, "has", truth->size(), arguments.left, pair.left.image.size());
  }

  FrameMatcher matcher(arguments.matcher, pair.left.image.size(), pool);
  if (pair.left.mask) matcher.use_masks(&*pair.left.mask, &*pair.right.mask);
  DisparityImage disparity(pair.left.image.size());
  matcher.match(pair.left.image.view(), pair.right.image.view(), disparity.view());

  if (arguments.matcher.hole_filling) {
    // Filled pixels are negative until include_filled(), so they count as unmatched here.
    if (truth)
      print_comparison(arguments, disparity, *truth,
                       arguments.ground_truth->string() + ", measured pixels only");
    const std::string line = include_filled(disparity);
    if (arguments.output || arguments.color) std::fputs(line.c_str(), stdout);
  }
  const int units = arguments.matcher.units_per_pixel();
  if (arguments.output) write_disparity(*arguments.output, disparity.view(), units);
  if (arguments.color) write_view(arguments, disparity, calibration);
  if (arguments.rectified) {
    write_png(arguments.rectified->left, pair.left.image.view());
    write_png(arguments.rectified->right, pair.right.image.view());
  }
  if (truth) {
    print_comparison(arguments, disparity, *truth,
                     arguments.ground_truth->string() +
                         (arguments.matcher.hole_filling ? ", measured and filled pixels" : ""));
  }
  if (arguments.repeat > 0) {
    // The run above has touched all memory, so the first measured run does not include page faults.
    std::fputs(timing_line(measure(matcher, pair, disparity, arguments.repeat)).c_str(), stdout);
  }
}

int fail(int status, const char* message) {
  std::fprintf(stderr, "stereo-match: %s\n", message);
  return status;
}

int run_program(int argc, char** argv) {
  try {
    const auto arguments = parse_match_arguments(argc, argv);
    if (const auto* help = std::get_if<TextToPrint>(&arguments)) {
      std::fputs(help->text.c_str(), stdout);
    } else {
      run(std::get<MatchArguments>(arguments));
    }
    return 0;
  } catch (const FileError& error) {
    return fail(kBadInput, error.what());
  } catch (const UsageError& error) {
    return fail(kBadInput, error.what());
  } catch (const std::invalid_argument& error) {
    return fail(kBadInput, error.what());
  } catch (const std::exception& error) {
    return fail(kFailure, error.what());
  }
}

}  // namespace
}  // namespace stereod::tools

int main(int argc, char** argv) { return stereod::tools::run_program(argc, argv); }
