// SPDX-License-Identifier: BSD-3-Clause
// The order of formats and rates.
#include "daemon/capture/v4l2/format_fallbacks.h"

#include <algorithm>

namespace stereod::v4l2 {
namespace {

constexpr double kMinRate = 5;          // [Hz]
constexpr int kLowerRates = 2;          // after the configured one
constexpr double kMaxRateRatio = 0.68;  // of a lower rate to the previous one

bool reaches(const OfferedFormat& offer, double fps) {
  return offer.fastest() == 0 || offer.fastest() > 0.95 * fps;
}

const OfferedFormat* best(const std::vector<OfferedFormat>& offers, double fps, bool compressed) {
  const OfferedFormat* chosen = nullptr;
  for (const PixelFormat& format : pixel_formats()) {
    if ((format.work == LumaWork::kJpeg) != compressed) continue;
    for (const OfferedFormat& offer : offers) {
      if (offer.fourcc != format.fourcc) continue;
      const bool faster = chosen != nullptr && !reaches(*chosen, fps) && offer.fastest() > chosen->fastest();
      if (chosen == nullptr || faster) chosen = &offer;
    }
  }
  return chosen;
}

FormatRequest request(const OfferedFormat& offer, double fps) {
  return {offer.fourcc, offer.fastest() > 0 ? std::min(fps, offer.fastest()) : fps, false};
}

/// Returns the next lower rate [Hz], 0 if there is none.
double lower_rate(const OfferedRates& rates, double fps) {
  if (rates.listed.empty() || rates.range) {
    const double half = fps / 2;
    return rates.range && half < rates.listed.back() ? 0 : half;
  }
  const auto lower = std::find_if(rates.listed.begin(), rates.listed.end(),
                                  [&](double rate) { return rate < kMaxRateRatio * fps; });
  return lower == rates.listed.end() ? 0 : *lower;
}

void add_lower_rates(std::vector<FormatRequest>& fallbacks, const OfferedFormat& offer) {
  FormatRequest request = fallbacks.back();
  for (int i = 0; i < kLowerRates; ++i) {
    request.fps = lower_rate(offer.rates, request.fps);
    if (request.fps < kMinRate) return;
    fallbacks.push_back(request);
  }
}

std::vector<FormatRequest> automatic_fallbacks(const std::vector<OfferedFormat>& offers, double fps) {
  const OfferedFormat* plain = best(offers, fps, false);
  const OfferedFormat* compressed = best(offers, fps, true);
  if (plain == nullptr && compressed == nullptr) return {};
  std::vector<FormatRequest> fallbacks;
  // A compressed format at the full rate is better than an uncompressed one at a lower rate.
  const bool compressed_only = plain == nullptr || (!reaches(*plain, fps) && compressed != nullptr &&
                                                    compressed->fastest() > plain->fastest());
  if (!compressed_only) fallbacks.push_back(request(*plain, fps));
  if (compressed != nullptr) fallbacks.push_back(request(*compressed, fps));
  add_lower_rates(fallbacks, compressed != nullptr ? *compressed : *plain);
  return fallbacks;
}

}  // namespace

std::vector<FormatRequest> format_fallbacks(const std::vector<OfferedFormat>& offers, const std::string& name,
                                            double fps) {
  const bool automatic = name == "auto";
  for (const OfferedFormat& offer : offers) {
    const PixelFormat* format = find_pixel_format(offer.fourcc);
    if (!automatic && format != nullptr && format->name == name) return {request(offer, fps)};
  }
  if (!automatic) return {};
  std::vector<FormatRequest> fallbacks = automatic_fallbacks(offers, fps);
  if (fallbacks.empty() && !offers.empty()) {
    // libv4l2 decides which format it converts. The rates of the first one apply.
    fallbacks.push_back({make_fourcc('Y', 'U', '1', '2'), request(offers.front(), fps).fps, true});
    add_lower_rates(fallbacks, offers.front());
  }
  return fallbacks;
}

}  // namespace stereod::v4l2
