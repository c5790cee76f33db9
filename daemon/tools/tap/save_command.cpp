// SPDX-License-Identifier: BSD-3-Clause
// stereo-tap save: writes frames to files.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>

#include "daemon/base/stop_signals.h"
#include "daemon/client/stereod_client.h"
#include "daemon/imagefile/disparity_file.h"
#include "daemon/imagefile/write_image.h"
#include "daemon/lcm/message_decoder.h"
#include "daemon/lcm/receiver.h"
#include "daemon/tools/tap/frame_listener.h"
#include "daemon/tools/tap/tap.h"
#include "daemon/tools/tap/text_table.h"
#include "daemon/visual/disparity_rendering.h"

namespace stereod::tools {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// The daemon sends its camera information once a second.
constexpr std::chrono::seconds kMaxWaitForCameraInfo{2};

/// Returns the conversion to depth; empty if the message is uncalibrated or invalid.
std::optional<DepthScale> depth_scale_of(const camera_info_t& info) {
  const std::optional<CameraGeometry> camera = geometry_of(info);
  if (!camera) return std::nullopt;
  return DepthScale{camera->fx * camera->baseline_m, camera->disparity_offset};
}

/// Waits for the camera information. Returns empty if none arrives or it is uncalibrated.
std::optional<DepthScale> wait_for_depth_scale(LcmReceiver& receiver, const TapOptions& tap,
                                               StopSignals& stop) {
  // Shared, because the subscription outlives this function.
  const auto received = std::make_shared<std::optional<camera_info_t>>();
  receiver.subscribe(tap.channel("CAMERA_INFO"), [received](std::span<const std::byte> bytes) {
    camera_info_t info;
    if (decode_message(bytes, info)) *received = info;
  });
  const Clock::time_point end = Clock::now() + kMaxWaitForCameraInfo;
  while (!*received && Clock::now() < end && !stop.arrived()) receiver.receive(milliseconds(50));
  return *received ? depth_scale_of(**received) : std::nullopt;
}

double measured_share(DisparityView disparity) {
  std::int64_t valid = 0;
  for (int y = 0; y < disparity.height(); ++y) {
    for (int x = 0; x < disparity.width(); ++x) valid += disparity.at(x, y) >= 0 ? 1 : 0;
  }
  return static_cast<double>(valid) / (static_cast<double>(disparity.width()) * disparity.height());
}

/// Returns the position of the pixels in the rectified image; empty if they are the whole image.
std::string describe_grid(const PixelGrid& grid) {
  if (grid == PixelGrid{}) return "";
  return " (column " + std::to_string(grid.left) + ", row " + std::to_string(grid.top) + ", decimation " +
         std::to_string(grid.decimation_x) + " x " + std::to_string(grid.decimation_y) + ")";
}

/// Writes frame-NUMBER.pfm and frame-NUMBER.png and prints their names.
void save(const StereoFrame& frame, const std::filesystem::path& directory, std::optional<DepthScale> depth) {
  char name[40];
  std::snprintf(name, sizeof name, "frame-%06lld", static_cast<long long>(frame.frame));
  const std::filesystem::path pfm = directory / (std::string(name) + ".pfm");
  const std::filesystem::path png = directory / (std::string(name) + ".png");
  DisparityRenderingOptions rendering;
  rendering.depth = depth;

  const DisparityMap& map = frame.disparity;
  const DisparityView disparity(map.row(0), map.width(), map.height(),
                                map.width() * static_cast<std::ptrdiff_t>(sizeof(std::int16_t)));
  write_disparity_pfm(pfm, disparity, frame.units_per_pixel);
  const ColorImage image = draw_disparity(disparity, frame.units_per_pixel, rendering);
  write_png(png, image.view());
  std::printf("%s and .png: %d x %d%s, %s %% measured, scale in %s\n", pfm.c_str(), disparity.width(),
              disparity.height(), describe_grid(frame.grid).c_str(),
              fixed(100 * measured_share(disparity), 1).c_str(), depth ? "meters" : "pixels");
  std::fflush(stdout);
}

void make_directory(const std::filesystem::path& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) {
    throw std::runtime_error("cannot create the directory " + directory.string() + ": " + error.message());
  }
}

/// Frames that arrived.
struct Tally {
  int saved = 0;
  int incomplete = 0;
  Clock::time_point latest = Clock::now();
};

int report_result(const TapOptions& tap, const LcmReceiver& receiver, const SaveOptions& options,
                  const Tally& tally, const ReceptionCounts& counts) {
  if (counts.messages_of_another > 0) print_error(describe_problems(counts));
  if (tally.incomplete > 0) {
    print_error(std::to_string(tally.incomplete) + " incomplete frames not saved");
    if (const auto advice = receive_buffer_advice(kernel_receive_buffer_limit())) print_error(*advice);
  }
  if (tally.saved == options.frames) return counts.messages_of_another > 0 ? kSomethingLost : kSuccess;
  print_error("no complete frame on " + tap.channel("DISPARITY") + " and " + tap.channel("FRAME") + " for " +
              fixed(options.timeout_s, 1) + " s (" + receiver.url() + "), " + std::to_string(tally.saved) +
              " of " + std::to_string(options.frames) + " saved; is stereod streaming?");
  return tally.incomplete > 0 ? kSomethingLost : kNothingArrived;
}

}  // namespace

int run_save(const TapOptions& tap, const SaveOptions& options, StopSignals& stop) {
  make_directory(options.directory);
  LcmReceiver receiver(tap.lcm_url);
  const std::optional<DepthScale> depth = wait_for_depth_scale(receiver, tap, stop);
  Tally tally;
  FrameAssembler assembler([&](StereoFrame&& frame) {
    if (tally.saved == options.frames) return;
    if (!frame.complete() || frame.rows_received == 0) {
      // The first frame usually began before the subscription.
      tally.incomplete += tally.saved > 0 ? 1 : 0;
      return;
    }
    save(frame, options.directory, depth);
    ++tally.saved;
    tally.latest = Clock::now();
  });
  listen_for_frames(receiver, tap, assembler);

  const auto timeout = std::chrono::duration<double>(options.timeout_s);
  tally.latest = Clock::now();
  while (tally.saved < options.frames && !stop.arrived() && Clock::now() - tally.latest < timeout) {
    receiver.receive(milliseconds(50));
  }
  return stop.arrived() ? static_cast<int>(kSuccess)
                        : report_result(tap, receiver, options, tally, assembler.counts());
}

}  // namespace stereod::tools
