// SPDX-License-Identifier: BSD-3-Clause
// Geometry and textures of the room.
#include "daemon/capture/synthetic/synthetic_world.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace stereod {

namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();
constexpr float kWallDepth = 4.5F;
constexpr float kFloorY = 0.45F;
constexpr unsigned kWallTexture = 1;
constexpr unsigned kFloorTexture = 2;

std::uint32_t hash(std::uint32_t x, std::uint32_t y, std::uint32_t salt) {
  std::uint32_t h = x * 0x9e3779b1U ^ y * 0x85ebca77U ^ salt * 0xc2b2ae3dU;
  h = (h ^ (h >> 15)) * 0x2c1b3c6dU;
  h = (h ^ (h >> 12)) * 0x297a2d39U;
  return h ^ (h >> 15);
}

// Returns a pseudorandom number in [−1, 1) for each point of a lattice.
float lattice(int x, int y, std::uint32_t salt) {
  const auto bits =
      static_cast<std::int32_t>(hash(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), salt));
  return static_cast<float>(bits) * 0x1p-31F;
}

float interpolate(float a, float b, float part) { return a + part * (b - a); }

int floor_to_int(float value) {
  const int towards_zero = static_cast<int>(value);
  return towards_zero - (value < static_cast<float>(towards_zero) ? 1 : 0);
}

// Interpolates smoothly between the points of a lattice with spacing 1. std::floor and std::lerp would
// dominate the time of rendering.
float value_noise(float u, float v, std::uint32_t salt) {
  const int x = floor_to_int(u), y = floor_to_int(v);
  const float fu = u - static_cast<float>(x), fv = v - static_cast<float>(y);
  const float su = fu * fu * (3 - 2 * fu), sv = fv * fv * (3 - 2 * fv);
  const float upper = interpolate(lattice(x, y, salt), lattice(x + 1, y, salt), su);
  const float lower = interpolate(lattice(x, y + 1, salt), lattice(x + 1, y + 1, salt), su);
  return interpolate(upper, lower, sv);
}

}  // namespace

SyntheticWorld::SyntheticWorld(double focal_px, double baseline_m, int frames, bool boxes)
    : focal_px_(static_cast<float>(focal_px)),
      middle_x_(static_cast<float>(baseline_m / 2)),
      frames_(frames) {
  if (!boxes) return;
  unsigned texture = 16;
  const auto next_texture = [&] { return texture += 16; };
  still_ = {
      make_box(-0.75F, 0.10F, 2.30F, 0.26F, 0.35F, 0.20F, 0.4F, next_texture()),
      make_box(1.05F, 0.00F, 3.10F, 0.30F, 0.45F, 0.30F, -0.3F, next_texture()),
      make_box(0.25F, -0.46F, 1.60F, 0.36F, 0.12F, 0.05F, 0.0F, next_texture()),
      make_box(-0.27F, 0.20F, 0.72F, 0.09F, 0.10F, 0.06F, 0.5F, next_texture()),
  };
  moving_ = {
      {make_box(0.20F, 0.16F, 0.62F, 0.07F, 0.07F, 0.04F, -0.2F, next_texture()), 0.06F, 0.0F, 0.02F, 0.0F},
      {make_box(0.10F, 0.17F, 1.90F, 0.17F, 0.28F, 0.15F, 0.3F, next_texture()), 0.20F, 0.0F, 0.0F, 2.0F},
      {make_box(-0.40F, -0.20F, 1.30F, 0.13F, 0.13F, 0.10F, -0.5F, next_texture()), 0.0F, 0.08F, 0.15F, 4.0F},
  };
}

SyntheticWorld::Box SyntheticWorld::make_box(float x, float y, float z, float half_x, float half_y,
                                             float half_z, float yaw, unsigned texture) const {
  Box box{x, y, z, half_x, half_y, half_z, std::cos(yaw), std::sin(yaw), {}, texture};
  const float half[3] = {half_x, half_y, half_z};
  for (int axis = 0; axis < 3; ++axis) box.slant[axis] = cosine(box, x, y, z, axis, half[axis]);
  return box;
}

// Returns the cosine of the angle between a face's normal and the line of sight to a point on it, at least
// 0.1. The line of sight starts in the middle of the baseline, so that the cosine is the same for both
// cameras. The point is (x, y, z), moved toward the viewer by @p nearer along the normal.
float SyntheticWorld::cosine(const Box& box, float x, float y, float z, int axis, float nearer) const {
  x -= middle_x_;
  const float along[3] = {box.cos_yaw * x - box.sin_yaw * z, y, box.sin_yaw * x + box.cos_yaw * z};
  return std::max((std::abs(along[axis]) - nearer) / std::sqrt(x * x + y * y + z * z), 0.1F);
}

SceneHit SyntheticWorld::still_hit(const SceneRay& ray) const {
  const Box* nearest = nullptr;
  BoxHit hit{kNever, 0};
  for (const Box& box : still_) {
    const BoxHit candidate = meet(box, ray);
    if (candidate.depth < hit.depth) {
      hit = candidate;
      nearest = &box;
    }
  }
  const float floor_depth = ray.y > 0 ? kFloorY / ray.y : kNever;
  const float room_depth = std::min(floor_depth, kWallDepth);
  if (nearest != nullptr && hit.depth < room_depth) return {hit.depth, brightness(*nearest, hit, ray)};

  const float x = ray.origin_x + room_depth * ray.x;
  const float y = room_depth * ray.y;
  if (floor_depth > kWallDepth) return {room_depth, 120 + noise(kWallTexture, x, y, room_depth / focal_px_)};
  // The floor is seen at all angles down to grazing ones. Its texture is projected from the middle of the
  // baseline, so that its structure has the same size in pixels everywhere and in all directions.
  return {room_depth,
          105 + noise(kFloorTexture, (x - middle_x_) / room_depth, y / room_depth, 1 / focal_px_)};
}

// The slab method (Kay and Kajiya 1986), in the frame of the box.
SyntheticWorld::BoxHit SyntheticWorld::meet(const Box& box, const SceneRay& ray) {
  const float from_x = ray.origin_x - box.x;
  const float origin[3] = {box.cos_yaw * from_x + box.sin_yaw * box.z, -box.y,
                           box.sin_yaw * from_x - box.cos_yaw * box.z};
  const float direction[3] = {box.cos_yaw * ray.x - box.sin_yaw, ray.y, box.sin_yaw * ray.x + box.cos_yaw};
  const float half[3] = {box.half_x, box.half_y, box.half_z};
  float enter = 0, leave = kNever;
  int axis = 0;
  for (int i = 0; i < 3; ++i) {
    const float one = (-half[i] - origin[i]) / direction[i], other = (half[i] - origin[i]) / direction[i];
    const float first = std::min(one, other), last = std::max(one, other);
    if (first > enter) {
      enter = first;
      axis = i;
    }
    leave = std::min(leave, last);
  }
  return {enter < leave ? enter : kNever, axis};
}

float SyntheticWorld::brightness(const Box& box, const BoxHit& hit, const SceneRay& ray) const {
  const float x = ray.origin_x + hit.depth * ray.x - box.x;
  const float y = hit.depth * ray.y - box.y;
  const float z = hit.depth - box.z;
  const float local_x = box.cos_yaw * x - box.sin_yaw * z, local_z = box.sin_yaw * x + box.cos_yaw * z;

  // A slanted face has a texture stretched by the same factor, so that it looks even. The factor is constant
  // over the face, which keeps the texture fixed to it; where the face is slanted more, fine octaves are
  // omitted.
  const float slant = box.slant[hit.axis];
  const float u = hit.axis == 0 ? local_z * slant : hit.axis == 1 ? local_x : local_x * slant;
  const float v = hit.axis == 1 ? local_z * slant : y;
  const float here = cosine(box, x + box.x, y + box.y, hit.depth, hit.axis, 0);
  const float spacing = hit.depth / focal_px_ * std::max(1.0F, slant / here);
  const float shade[3] = {95, 150, 130};
  const auto face = static_cast<unsigned>(hit.axis);
  return shade[hit.axis] + noise(box.texture + face, u, v, spacing);
}

// Sums three to four octaves. The finest one has a lattice of 2 to 4 times @p spacing (the width of a pixel
// on the surface [m]). Octaves fade in and out, so that no edge is visible where their number changes.
float SyntheticWorld::noise(unsigned texture, float u, float v, float spacing) const {
  constexpr int kOctaves = 4;
  constexpr float kContrast = 95;
  const float level = -std::log2(2 * spacing);
  const float finest = std::floor(level);
  const float fade = level - finest;
  float sum = 0, power = 0;
  for (int i = 0; i < kOctaves; ++i) {
    const float weight = i == 0 ? fade : i == kOctaves - 1 ? 1 - fade : 1;
    const int octave = static_cast<int>(finest) - i;
    const float scale = std::ldexp(1.0F, octave);
    sum += weight * value_noise(u * scale, v * scale, texture * 64 + static_cast<unsigned>(octave + 32));
    power += weight * weight;
  }
  return kContrast * sum / std::sqrt(power);
}

SyntheticWorld::MovingBoxes SyntheticWorld::moving_boxes(int frame, float origin_x) const {
  MovingBoxes result;
  result.world_ = this;
  const float turn =
      2 * std::numbers::pi_v<float> * static_cast<float>(frame % frames_) / static_cast<float>(frames_);
  for (const Motion& motion : moving_) {
    const float swing = std::sin(turn + motion.phase);
    Box box = motion.box;
    box.x += swing * motion.by_x;
    box.y += swing * motion.by_y;
    box.z += swing * motion.by_z;
    MovingBoxes::Seen seen{box, kNever, -kNever, kNever, -kNever};
    for (int corner = 0; corner < 8; ++corner) {
      const float x = (corner & 1) != 0 ? box.half_x : -box.half_x;
      const float y = (corner & 2) != 0 ? box.half_y : -box.half_y;
      const float z = (corner & 4) != 0 ? box.half_z : -box.half_z;
      const float depth = box.z - box.sin_yaw * x + box.cos_yaw * z;
      const float across = (box.x + box.cos_yaw * x + box.sin_yaw * z - origin_x) / depth;
      const float down = (box.y + y) / depth;
      seen.left = std::min(seen.left, across), seen.right = std::max(seen.right, across);
      seen.top = std::min(seen.top, down), seen.bottom = std::max(seen.bottom, down);
    }
    result.boxes_.push_back(seen);
  }
  return result;
}

SceneHit SyntheticWorld::MovingBoxes::hit(const SceneRay& ray, SceneHit behind) const {
  for (const Seen& seen : boxes_) {
    if (ray.x < seen.left || ray.x > seen.right || ray.y < seen.top || ray.y > seen.bottom) continue;
    const BoxHit hit = meet(seen.box, ray);
    if (hit.depth < behind.depth) behind = {hit.depth, world_->brightness(seen.box, hit, ray)};
  }
  return behind;
}

}  // namespace stereod
