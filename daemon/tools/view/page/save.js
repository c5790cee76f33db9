// SPDX-License-Identifier: BSD-3-Clause
// Saves a frame to files.
import { fetchedSize } from './geometry.js';

function download(name, blob) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// The disparities [px of the rectified image] as PFM, infinite where there is none, as stereo-tap save writes them.
function pfmOf(frame, values) {
  const [width, height] = fetchedSize(frame);
  const head = new TextEncoder().encode(`Pf\n${width} ${height}\n-1\n`);
  const body = new Float32Array(width * height);
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const value = values[y * width + x];
      body[(height - 1 - y) * width + x] = value < 0 ? Infinity : value / frame.units_per_pixel;
    }
  }
  return new Blob([head, body]);
}

// Downloads the disparities (.pfm, .png) and, unless `leftCanvas` is null, the left image.
export function saveFrame(frame, values, disparityCanvas, leftCanvas) {
  const name = 'frame-' + String(frame.frame).padStart(6, '0');
  download(name + '.pfm', pfmOf(frame, values));
  disparityCanvas.toBlob(blob => download(name + '.png', blob));
  if (leftCanvas) leftCanvas.toBlob(blob => download(name + '-left.png', blob));
}
