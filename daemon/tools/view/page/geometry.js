// SPDX-License-Identifier: BSD-3-Clause
// Where published pixels lie, and how far away what they show is. `frame` is the frame of a snapshot's JSON.

// Distance along the optical axis [m] of a disparity in fixed-point units; infinite at the horizon.
export function depthOf(units, frame) {
  const shift = units / frame.units_per_pixel + frame.camera.disparity_offset;
  return shift > 0 ? frame.camera.fx * frame.camera.baseline_m / shift : Infinity;
}

// Column and row in the rectified image of a published pixel.
export const rectifiedX = (frame, x) => frame.left + x * frame.decimation_x;
export const rectifiedY = (frame, y) => frame.top + y * frame.decimation_y;

// Published column and row of a pixel of the rectified image.
export const publishedX = (frame, x) => Math.floor((x - frame.left) / frame.decimation_x);
export const publishedY = (frame, y) => Math.floor((y - frame.top) / frame.decimation_y);

// Width and height of the disparities that the page fetched: every step-th published column and row.
export const fetchedSize = frame => [Math.ceil(frame.width / frame.step), Math.ceil(frame.height / frame.step)];

// The disparity and depth of the published pixel (x, y); null outside the image.
export function valueAt(frame, values, x, y) {
  if (!frame || x < 0 || y < 0 || x >= frame.width || y >= frame.height) return null;
  const [width] = fetchedSize(frame);
  const value = values[Math.floor(y / frame.step) * width + Math.floor(x / frame.step)];
  return { value, disparity: value < 0 ? null : value / frame.units_per_pixel,
           depth: value < 0 || !frame.camera ? null : depthOf(value, frame) };
}
