// What there is to see in the synthetic scene, and what a ray meets in it.
#pragma once

#include <limits>
#include <vector>

namespace stereod {

/// A ray of the rectified stereo pair: from (origin_x, 0, 0) along (x, y, 1). A point on it is known by its
/// depth, its z in meters.
struct SceneRay {
  float origin_x = 0;
  float x = 0;
  float y = 0;
};

/// Where a ray ends.
struct SceneHit {
  float depth = std::numeric_limits<float>::infinity();
  float brightness = 0;  ///< of the surface there, 0…255, before camera and exposure
};

/// A room: floor, back wall, boxes that stand still and boxes that move to and fro once in a loop of frames.
/// The world's coordinates are those of the rectified left camera, in meters: x to the right, y down, z
/// forward.
///
/// Every surface carries a texture of its own, fixed to it: value noise of several octaves, the finest about
/// three pixels apart at the surface's distance and none finer, so that block matching finds structure
/// everywhere and no camera sees aliasing. The brightness of a point does not depend on the camera that looks
/// at it.
class SyntheticWorld {
 public:
  /// `focal_px`: focal length of the rectified cameras; the textures are made for it. `boxes`: false leaves
  /// the room empty.
  SyntheticWorld(double focal_px, double baseline_m, int frames, bool boxes = true);

  /// What the ray meets of that which never moves. Always something: the wall closes the room.
  SceneHit still_hit(const SceneRay& ray) const;

  /// The boxes that move, at their places in one frame.
  class MovingBoxes;
  MovingBoxes moving_boxes(int frame, float origin_x) const;

 private:
  struct Box {
    float x, y, z;                 // center
    float half_x, half_y, half_z;  // half the sides
    float cos_yaw, sin_yaw;        // turned about the y axis
    float slant[3];                // cosines under which the faces across x, y and z are seen
    unsigned texture;
  };
  struct Motion {
    Box box;
    float by_x, by_y, by_z;  // to and fro by so much, meters
    float phase;             // of the loop, radians
  };
  struct BoxHit {
    float depth;
    int axis;  // of the face's normal, in the box's frame
  };

  Box make_box(float x, float y, float z, float half_x, float half_y, float half_z, float yaw,
               unsigned texture) const;
  static BoxHit meet(const Box& box, const SceneRay& ray);
  float brightness(const Box& box, const BoxHit& hit, const SceneRay& ray) const;
  float cosine(const Box& box, float x, float y, float z, int axis, float nearer) const;
  float noise(unsigned texture, float u, float v, float spacing) const;

  float focal_px_;
  float middle_x_;  // of the baseline
  int frames_;
  std::vector<Box> still_;
  std::vector<Motion> moving_;
};

/// Seen from one camera.
class SyntheticWorld::MovingBoxes {
 public:
  /// The nearer of `behind` and what the ray, which starts at this camera, meets of the moving boxes.
  SceneHit hit(const SceneRay& ray, SceneHit behind) const;

 private:
  friend class SyntheticWorld;
  struct Seen {
    Box box;
    float left, right, top, bottom;  // all its points have x/z and y/z within these
  };

  const SyntheticWorld* world_ = nullptr;
  std::vector<Seen> boxes_;
};

}  // namespace stereod
