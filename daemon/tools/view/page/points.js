// SPDX-License-Identifier: BSD-3-Clause
// Makes the point cloud of a frame.
import { depthOf, fetchedSize, rectifiedX, rectifiedY } from './geometry.js';

const kMaxDepth = 20;  // m
let points = new Float32Array(0);  // reused from frame to frame

// x, y, z [m] and brightness [0…1] of the measured pixels, about `spacing` px of the rectified image apart. `left` is the
// ImageData of the left image, or null.
export function pointsOf(frame, values, left, spacing) {
  const [width, height] = fetchedSize(frame);
  const k = Math.max(1, Math.round(Math.min(spacing / frame.step, width / 100)));
  const maximum = 4 * Math.ceil(width / k) * Math.ceil(height / k);
  if (points.length < maximum) points = new Float32Array(maximum);
  const { fx, fy, cx, cy } = frame.camera;
  let n = 0;
  for (let y = 0; y < height; y += k) {
    for (let x = 0; x < width; x += k) {
      const value = values[y * width + x];
      if (value < 0) continue;
      const z = depthOf(value, frame);
      if (!(z < kMaxDepth)) continue;
      const px = rectifiedX(frame, x * frame.step), py = rectifiedY(frame, y * frame.step);
      const inLeft = left && px < left.width && py < left.height;
      points[n] = (px - cx) * z / fx;
      points[n + 1] = (py - cy) * z / fy;
      points[n + 2] = z;
      points[n + 3] = inLeft ? left.data[4 * (py * left.width + px)] / 255 : 0.8;
      n += 4;
    }
  }
  return points.subarray(0, n);
}
