// SPDX-License-Identifier: BSD-3-Clause
// Rendering of a street.
#include "tests/bench/street_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace stereod::bench {
namespace {

constexpr int kWidth = 640, kHeight = 480, kDisparities = 64;
constexpr float kFocal = 500, kBaseline = 0.24F, kCenterX = 320, kCenterY = 200;
constexpr float kNever = std::numeric_limits<float>::infinity();

// A rectangle across one axis (0: x, 1: y, 2: z) at a place along it, meters: x to the right, y down, z
// ahead.
struct Patch {
  StreetPart part;
  int axis;
  float place;
  float low[2], high[2];  // of the other two axes, in order
};

// Three surfaces that go on along the street, and what stands in it.
std::vector<Patch> make_patches() {
  constexpr float kRoadY = 1.2F, kPavementY = 1.05F, kKerb = 2.2F, kHouses = 4.5F, kFar = 40;
  std::vector<Patch> patches{
      {StreetPart::kRoad, 1, kRoadY, {-kKerb, 0}, {kKerb, kFar}},
      {StreetPart::kPavement, 1, kPavementY, {-kHouses, 0}, {-kKerb, kFar}},
      {StreetPart::kPavement, 1, kPavementY, {kKerb, 0}, {kHouses, kFar}},
      {StreetPart::kPavement, 0, -kKerb, {kPavementY, 0}, {kRoadY, kFar}},  // the kerbs' faces
      {StreetPart::kPavement, 0, kKerb, {kPavementY, 0}, {kRoadY, kFar}},
      {StreetPart::kPlainFacade, 0, -kHouses, {-7, 0}, {kPavementY, 28}},
      {StreetPart::kFacade, 0, kHouses, {-5, 0}, {kPavementY, 22}},
      {StreetPart::kFacade, 2, kFar, {-30, -4}, {30, kRoadY}},
  };
  struct Pole {
    float x, z, width;
  };
  for (const Pole& pole : {Pole{-2.6F, 5, 0.1F}, Pole{-2.7F, 9, 0.1F}, Pole{-2.6F, 14, 0.11F},
                           Pole{2.5F, 4.2F, 0.05F}, Pole{2.6F, 6, 0.05F}, Pole{2.5F, 8, 0.06F},
                           Pole{2.7F, 11, 0.09F}, Pole{3.4F, 7, 0.08F}, Pole{-3.5F, 8, 0.05F}}) {
    patches.push_back({StreetPart::kPole, 2, pole.z, {pole.x, -2.6F}, {pole.x + pole.width, kPavementY}});
  }
  // A car's back and its side.
  patches.push_back({StreetPart::kCar, 2, 7, {0.6F, -0.2F}, {2.1F, 1}});
  patches.push_back({StreetPart::kCar, 0, 0.6F, {-0.2F, 7}, {1, 11}});
  return patches;
}

float lattice(int x, int y, std::uint32_t salt) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x8da6b343U ^
                    static_cast<std::uint32_t>(y) * 0xd8163841U ^ salt * 0xcb1ab31fU;
  h = (h ^ (h >> 16)) * 0x7feb352dU;
  h = (h ^ (h >> 15)) * 0x846ca68bU;
  return static_cast<float>(h >> 8) / static_cast<float>(1 << 23) - 1;
}

float smooth_noise(float u, float v, std::uint32_t salt) {
  const float x = std::floor(u), y = std::floor(v);
  const float fu = u - x, fv = v - y;
  const float su = fu * fu * (3 - 2 * fu), sv = fv * fv * (3 - 2 * fv);
  const int ix = static_cast<int>(x), iy = static_cast<int>(y);
  return std::lerp(std::lerp(lattice(ix, iy, salt), lattice(ix + 1, iy, salt), su),
                   std::lerp(lattice(ix, iy + 1, salt), lattice(ix + 1, iy + 1, salt), su), sv);
}

// Octaves from half a meter down to 8 mm; those finer than two of `footprint`, a pixel's size on the surface,
// are left out.
float texture(float u, float v, float footprint, std::uint32_t salt) {
  float sum = 0;
  for (int octave = 1; octave <= 7; ++octave) {
    const float scale = std::ldexp(1.0F, octave);
    const float weight = std::clamp(2 - 2 * footprint * scale, 0.0F, 1.0F);
    if (weight > 0)
      sum += weight * smooth_noise(u * scale, v * scale, salt + static_cast<std::uint32_t>(octave));
  }
  return sum;
}

float brightness(const Patch& patch, float u, float v, float footprint) {
  const auto salt = static_cast<std::uint32_t>(patch.part) * 64 + static_cast<std::uint32_t>(patch.axis) * 16;
  const float noise = texture(u, v, footprint, salt);
  const auto part_of = [](float value, float period) { return value / period - std::floor(value / period); };
  switch (patch.part) {
    case StreetPart::kRoad:
      return 90 + 9 * noise;
    case StreetPart::kPavement: {
      const bool joint = part_of(u, 0.5F) < 0.03F || part_of(v, 0.5F) < 0.03F;
      return (joint ? 100.0F : 135.0F) + 8 * noise;
    }
    case StreetPart::kPlainFacade: {
      const bool window = part_of(u, 2.8F) < 0.5F && part_of(v, 3) < 0.4F;
      return window ? 60 + 2 * noise : 190 + 1.5F * noise;
    }
    case StreetPart::kFacade: {
      const bool joint = part_of(v, 0.6F) < 0.06F || part_of(u, 0.3F) < 0.07F;
      return (joint ? 95.0F : 125.0F) + 14 * noise;
    }
    case StreetPart::kPole:
      return 70 + 6 * noise;
    default:
      return 150 + 5 * noise;
  }
}

struct Seen {
  StreetPart part = StreetPart::kSky;
  float depth = kNever;
  float gray = 235;
};

Seen look(const std::vector<Patch>& patches, float camera_x, float x, float y) {
  const float origin[3] = {camera_x, 0, 0};
  const float ray[3] = {(x - kCenterX) / kFocal, (y - kCenterY) / kFocal, 1};
  Seen seen;
  for (const Patch& patch : patches) {
    const float depth = (patch.place - origin[patch.axis]) / ray[patch.axis];  // the ray's z is 1
    if (!(depth > 0.5F) || depth >= seen.depth) continue;
    const int first = patch.axis == 0 ? 1 : 0;
    const int second = patch.axis == 2 ? 1 : 2;
    const float u = origin[first] + depth * ray[first], v = origin[second] + depth * ray[second];
    if (u < patch.low[0] || u >= patch.high[0] || v < patch.low[1] || v >= patch.high[1]) continue;
    // A pixel's size on the surface; longer where the surface runs away from the camera.
    const float footprint = depth / kFocal / std::clamp(std::abs(ray[patch.axis]), 0.05F, 1.0F);
    seen = {patch.part, depth, brightness(patch, u, v, footprint)};
  }
  return seen;
}

cv::Mat1f render(const std::vector<Patch>& patches, float camera_x) {
  constexpr int kRays = 3;  // each way in a pixel
  cv::Mat1f image(kHeight, kWidth, 0.0F);
  const auto offset = [](int i) { return (static_cast<float>(i) + 0.5F) / kRays - 0.5F; };
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (int i = 0; i < kRays * kRays; ++i) {
        image(y, x) += look(patches, camera_x, static_cast<float>(x) + offset(i % kRays),
                            static_cast<float>(y) + offset(i / kRays))
                           .gray /
                       (kRays * kRays);
      }
    }
  }
  return image;
}

cv::Mat as_seen(const cv::Mat1f& image, std::uint64_t seed) {
  constexpr double kNoise = 2;
  cv::Mat1f noise(image.size());
  cv::RNG(seed).fill(noise, cv::RNG::NORMAL, 0, kNoise);
  cv::Mat seen;
  cv::add(image, noise, seen, cv::noArray(), CV_8U);
  return seen;
}

}  // namespace

Street street() {
  const std::vector<Patch> patches = make_patches();
  Street result{{"street", as_seen(render(patches, 0), 1), as_seen(render(patches, kBaseline), 2),
                 Image<float>(kWidth, kHeight), kDisparities},
                cv::Mat1b(kHeight, kWidth)};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const Seen seen = look(patches, 0, static_cast<float>(x), static_cast<float>(y));
      result.part(y, x) = static_cast<unsigned char>(seen.part);
      result.set.truth.at(x, y) = seen.part == StreetPart::kSky ? kNever : kFocal * kBaseline / seen.depth;
    }
  }
  return result;
}

}  // namespace stereod::bench
