#include "daemon/capture/v4l2/format_choice.h"

#include <algorithm>

namespace stereod {
namespace {

constexpr double kLowestRate = 5;

bool reaches(const OfferedFormat& offer, double fps) {
  return offer.fastest == 0 || offer.fastest > 0.95 * fps;
}

const OfferedFormat* best(const std::vector<OfferedFormat>& offers, double fps, bool compressed) {
  const OfferedFormat* chosen = nullptr;
  for (const PixelFormat& format : pixel_formats()) {
    if ((format.work == LumaWork::kJpeg) != compressed) continue;
    for (const OfferedFormat& offer : offers) {
      if (offer.pixels != format.pixels) continue;
      const bool faster = chosen != nullptr && !reaches(*chosen, fps) && offer.fastest > chosen->fastest;
      if (chosen == nullptr || faster) chosen = &offer;
    }
  }
  return chosen;
}

FormatRequest request(const OfferedFormat& offer, double fps) {
  return {offer.pixels, offer.fastest > 0 ? std::min(fps, offer.fastest) : fps, false};
}

std::vector<FormatRequest> automatic_ladder(const std::vector<OfferedFormat>& offers, double fps) {
  const OfferedFormat* plain = best(offers, fps, false);
  const OfferedFormat* compressed = best(offers, fps, true);
  if (plain == nullptr && compressed == nullptr) return {};
  std::vector<FormatRequest> ladder;
  // A slow uncompressed format is worse than a compressed one at the full rate.
  const bool compressed_only = plain == nullptr || (!reaches(*plain, fps) && compressed != nullptr &&
                                                    compressed->fastest > plain->fastest);
  if (!compressed_only) ladder.push_back(request(*plain, fps));
  if (compressed != nullptr) ladder.push_back(request(*compressed, fps));
  const FormatRequest last = ladder.back();
  for (const double share : {0.5, 0.25}) {
    if (last.fps * share >= kLowestRate) ladder.push_back({last.pixels, last.fps * share, false});
  }
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
  if (ladder.empty() && !offers.empty()) ladder.push_back({fourcc('Y', 'U', '1', '2'), fps, true});
  return ladder;
}

}  // namespace stereod
