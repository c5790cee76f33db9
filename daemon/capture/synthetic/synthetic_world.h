// SPDX-License-Identifier: BSD-3-Clause
// The objects of the synthetic scene, and where rays meet them.
#pragma once

#include <limits>
#include <vector>

namespace stereod {

/// A ray of the rectified stereo pair: from (origin_x, 0, 0) along (x, y, 1). A point on it is given by its
/// depth z [m].
struct SceneRay {
  float origin_x = 0;
  float x = 0;
  float y = 0;
};

/// Where a ray meets a surface.
struct SceneHit {
  float depth = std::numeric_limits<float>::infinity();
  float brightness = 0;  ///< of the surface [0…255], before camera and exposure
};

/// A room with a floor, a back wall, static boxes, and boxes that oscillate once in a loop of frames.
/// Coordinates are those of the rectified left camera [m]: x right, y down, z forward.
///
/// Every surface has its own texture, fixed to it: value noise of several octaves. The finest octave has a
/// period of about three pixels at the surface's distance, so that block matching finds structure everywhere
/// and no camera sees aliasing. The brightness of a point is the same for all cameras.
class SyntheticWorld {
 public:
  /// @p focal_px [px]: focal length of the rectified cameras, for which the textures are scaled. @p boxes:
  /// false leaves the room empty.
  SyntheticWorld(double focal_px, double baseline_m, int frames, bool boxes = true);

  /// Returns where the ray meets the static part of the room; the wall closes it, so there always is such a
  /// point.
  SceneHit still_hit(const SceneRay& ray) const;

  /// The moving boxes at their places in one frame.
  class MovingBoxes;
  MovingBoxes moving_boxes(int frame, float origin_x) const;

 private:
  struct Box {
    float x, y, z;                 // center
    float half_x, half_y, half_z;  // half the sides
    float cos_yaw, sin_yaw;        // rotation about the y axis
    float slant[3];                // cosine of the viewing angle of the faces normal to x, y and z
    unsigned texture;
  };
  struct Motion {
    Box box;
    float by_x, by_y, by_z;  // amplitude [m]
    float phase;             // in the loop [rad]
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

/// The moving boxes as one camera sees them.
class SyntheticWorld::MovingBoxes {
 public:
  /// Returns the nearer one of @p behind and the point at which the ray, which starts at this camera, meets a
  /// moving box.
  SceneHit hit(const SceneRay& ray, SceneHit behind) const;

 private:
  friend class SyntheticWorld;
  struct Seen {
    Box box;
    float left, right, top, bottom;  // bounds of x/z and y/z of all its points
  };

  const SyntheticWorld* world_ = nullptr;
  std::vector<Seen> boxes_;
};

}  // namespace stereod
