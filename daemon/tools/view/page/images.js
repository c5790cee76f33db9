// SPDX-License-Identifier: BSD-3-Clause
// Draws the left image and the disparities.
import { depthOf, fetchedSize } from './geometry.js';
import { palette, unmatched } from './palette.js';  // from daemon/visual/color_map.h, by the server

const byId = id => document.getElementById(id);
const contextOf = canvas => canvas.getContext('2d', { willReadFrequently: true });

export let leftImage = null;  // ImageData of the latest left image

export function drawLeft(image) {
  const canvas = byId('left'), context = contextOf(canvas);
  byId('no-left').hidden = Boolean(image);
  if (!image) {
    leftImage = null;
    context.clearRect(0, 0, canvas.width, canvas.height);
    return;
  }
  const width = image.displayWidth || image.width, height = image.displayHeight || image.height;
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
  context.drawImage(image, 0, 0);
  image.close();
  leftImage = context.getImageData(0, 0, width, height);
}

// The color of every 16-bit disparity, for one range of disparities.
const colors = { minimum: 0, range: 0, table: new Uint32Array(65536) };

function updateColors(minimum, range) {
  if (colors.minimum === minimum && colors.range === range) return;
  const bytes = new Uint8Array(colors.table.buffer);
  for (let value = -32768; value < 32768; ++value) {
    const nearness = Math.min(1, Math.max(0, (value - minimum) / range));
    bytes.set([...value < 0 ? unmatched : palette[Math.round(nearness * (palette.length - 1))], 255], 4 * (value & 0xFFFF));
  }
  Object.assign(colors, { minimum, range });
}

let disparityImage = null;

export function drawDisparity(frame, values) {
  const [width, height] = fetchedSize(frame), canvas = byId('disparity');
  if (!disparityImage || canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
    disparityImage = new ImageData(width, height);
  }
  updateColors(frame.min_disparity * frame.units_per_pixel, Math.max(frame.disparities * frame.units_per_pixel - 1, 1));
  const pixels = new Uint32Array(disparityImage.data.buffer);
  for (let i = 0; i < values.length; ++i) pixels[i] = colors.table[values[i] & 0xFFFF];
  contextOf(canvas).putImageData(disparityImage, 0, 0);
  const far = frame.min_disparity, near = frame.min_disparity + frame.disparities;
  byId('scale').textContent = frame.camera
    ? `${far} px (far) to ${near} px (${depthOf(near * frame.units_per_pixel, frame).toFixed(2)} m)`
    : `${far} px (far) to ${near} px (near), uncalibrated`;
}
