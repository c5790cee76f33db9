// SPDX-License-Identifier: BSD-3-Clause
// The steps from a video node to an agreed format and rate.
#include "daemon/capture/v4l2/stream_setup.h"

#include <algorithm>
#include <vector>

#include "core/base/text.h"
#include "daemon/capture/v4l2/format_fallbacks.h"

namespace stereod::v4l2 {
namespace {

std::optional<CameraFault> open_capture_device(VideoDevice& device, const std::string& node,
                                               StreamInfo& info) {
  if (const int error = device.open(node, false)) return fault_of(SetupStage::kOpen, error, node);
  if (const int error = device.capability(info.device)) return fault_of(SetupStage::kCapability, error, node);
  if (info.device.captures && info.device.streams) return std::nullopt;
  return CameraFault{CameraReason::kNoCamera, SetupStage::kCapability, 0,
                     node +
                         " gives no images (a camera's second node holds only metadata); "
                         "'stereod --list-cameras' shows the right one"};
}

CameraFault no_format(const StreamOptions& options, const DeviceCapability& device,
                      const std::vector<OfferedFormat>& offers) {
  std::string sentence = options.node + " (" + device.card + ") has no " + to_string(options.size) +
                         (options.format == "auto" ? "" : " as " + options.format) + "; ";
  if (offers.empty()) {
    sentence += "'stereod --list-cameras' shows the sizes it has";
  } else {
    sentence += "at that size it offers ";
    for (std::size_t i = 0; i < offers.size(); ++i) {
      const PixelFormat* format = find_pixel_format(offers[i].fourcc);
      sentence += (i > 0 ? ", " : "") +
                  (format != nullptr ? std::string(format->name) : fourcc_name(offers[i].fourcc));
    }
  }
  return {CameraReason::kNoFormat, SetupStage::kListSizes, 0, std::move(sentence)};
}

std::optional<CameraFault> choose_format(VideoDevice& device, const StreamOptions& options, StreamInfo& info,
                                         FormatRequest& request) {
  std::vector<std::uint32_t> formats;
  if (const int error = device.formats(formats)) {
    return fault_of(SetupStage::kListFormats, error, options.node);
  }
  std::vector<OfferedFormat> offers;
  for (const std::uint32_t fourcc : formats) {
    bool offered = false;
    if (const int error = device.offers_size(fourcc, options.size, offered)) {
      return fault_of(SetupStage::kListSizes, error, options.node);
    }
    if (offered) offers.push_back({fourcc, device.rates(fourcc, options.size)});
  }
  const std::vector<FormatRequest> fallbacks = format_fallbacks(offers, options.format, options.fps);
  if (fallbacks.empty()) return no_format(options, info.device, offers);
  info.fallback_levels = static_cast<int>(fallbacks.size());
  request =
      fallbacks[static_cast<std::size_t>(std::clamp(options.fallback_level, 0, info.fallback_levels - 1))];
  return std::nullopt;
}

std::optional<CameraFault> agree_on_format(VideoDevice& device, const StreamOptions& options,
                                           const FormatRequest& request, StreamInfo& info) {
  // The request is recorded first: if the bus is full, the sentence names what was asked for.
  info.format = {request.fourcc, options.size, 0, 0};
  info.pixel_format = find_pixel_format(request.fourcc);
  info.fps = request.fps;
  info.converted = request.convert;
  if (const int error = device.set_format(info.format)) {
    return fault_of(SetupStage::kSetFormat, error, options.node);
  }
  if (info.format.fourcc == request.fourcc && info.format.size == options.size) return std::nullopt;
  return CameraFault{CameraReason::kOtherFormat, SetupStage::kSetFormat, 0,
                     options.node + " was asked for " + fourcc_name(request.fourcc) + " " +
                         to_string(options.size) + " and gives " + fourcc_name(info.format.fourcc) + " " +
                         to_string(info.format.size) + "; set cameras.v4l2 to what it gives"};
}

}  // namespace

std::string describe(const StreamInfo& info) {
  if (info.pixel_format == nullptr) return {};
  return fourcc_name(info.format.fourcc) + " " + to_string(info.format.size) + " at " +
         significant(info.fps, 4) + " Hz" + (info.converted ? " (converted by libv4l2)" : "");
}

std::optional<CameraFault> set_up_device(VideoDevice& device, const StreamOptions& options,
                                         StreamInfo& info) {
  info = {};
  const std::string& node = options.node;
  if (auto fault = open_capture_device(device, node, info)) return fault;
  FormatRequest request;
  if (auto fault = choose_format(device, options, info, request)) return fault;
  if (request.convert) {
    if (const int error = device.open(node, true)) return fault_of(SetupStage::kOpen, error, node);
  }
  if (auto fault = agree_on_format(device, options, request, info)) return fault;
  double actual = 0;
  if (const int error = device.set_rate(request.fps, actual)) {
    return fault_of(SetupStage::kSetRate, error, node);
  }
  if (actual > 0) info.fps = actual;
  return std::nullopt;
}

}  // namespace stereod::v4l2
