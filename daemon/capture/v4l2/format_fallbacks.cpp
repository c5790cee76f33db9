#include "daemon/capture/v4l2/format_fallbacks.h"

#include <algorithm>

namespace stereod {
namespace {

constexpr double kLowestRate = 5;
constexpr int kLowerRates = 2;  // after the wanted one

bool reaches(const OfferedFormat& offer, double fps) {
  return offer.fastest() == 0 || offer.fastest() > 0.95 * fps;
}

const OfferedFormat* best(const std::vector<OfferedFormat>& offers, double fps, bool compressed) {
  const OfferedFormat* chosen = nullptr;
  for (const PixelFormat& format : pixel_formats()) {
    if ((format.work == LumaWork::kJpeg) != compressed) continue;
    for (const OfferedFormat& offer : offers) {
      if (offer.pixels != format.pixels) continue;
      const bool faster = chosen != nullptr && !reaches(*chosen, fps) && offer.fastest() > chosen->fastest();
      if (chosen == nullptr || faster) chosen = &offer;
    }
  }
  return chosen;
}

FormatRequest request(const OfferedFormat& offer, double fps) {
  return {offer.pixels, offer.fastest() > 0 ? std::min(fps, offer.fastest()) : fps, false};
}

/// The next rate below `fps` that is worth a step; 0: none.
double lower_rate(const OfferedRates& rates, double fps) {
  if (rates.listed.empty() || rates.range) {
    const double half = fps / 2;
    return rates.range && half < rates.listed.back() ? 0 : half;
  }
  const auto lower =
      std::find_if(rates.listed.begin(), rates.listed.end(), [&](double rate) { return rate < 0.68 * fps; });
  return lower == rates.listed.end() ? 0 : *lower;
}

void add_lower_rates(std::vector<FormatRequest>& ladder, const OfferedFormat& offer) {
  FormatRequest request = ladder.back();
  for (int i = 0; i < kLowerRates; ++i) {
    request.fps = lower_rate(offer.rates, request.fps);
    if (request.fps < kLowestRate) return;
    ladder.push_back(request);
  }
}

std::vector<FormatRequest> automatic_ladder(const std::vector<OfferedFormat>& offers, double fps) {
  const OfferedFormat* plain = best(offers, fps, false);
  const OfferedFormat* compressed = best(offers, fps, true);
  if (plain == nullptr && compressed == nullptr) return {};
  std::vector<FormatRequest> ladder;
  // A slow uncompressed format is worse than a compressed one at the full rate.
  const bool compressed_only = plain == nullptr || (!reaches(*plain, fps) && compressed != nullptr &&
                                                    compressed->fastest() > plain->fastest());
  if (!compressed_only) ladder.push_back(request(*plain, fps));
  if (compressed != nullptr) ladder.push_back(request(*compressed, fps));
  add_lower_rates(ladder, compressed != nullptr ? *compressed : *plain);
  return ladder;
}

}  // namespace

std::vector<FormatRequest> format_ladder(const std::vector<OfferedFormat>& offers, const std::string& name,
                                         double fps) {
  const bool automatic = name == "auto";
  for (const OfferedFormat& offer : offers) {
    const PixelFormat* format = find_pixel_format(offer.pixels);
    if (!automatic && format != nullptr && format->name == name) return {request(offer, fps)};
  }
  if (!automatic) return {};
  std::vector<FormatRequest> ladder = automatic_ladder(offers, fps);
  if (ladder.empty() && !offers.empty()) {
    // Which of its formats is converted libv4l2 decides; the rates are those of the first.
    ladder.push_back({fourcc('Y', 'U', '1', '2'), request(offers.front(), fps).fps, true});
    add_lower_rates(ladder, offers.front());
  }
  return ladder;
}

}  // namespace stereod
