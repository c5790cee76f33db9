// SPDX-License-Identifier: BSD-3-Clause
// Fetches and decodes snapshots: see snapshot_codec.cpp for the format.
import { fetchedSize } from './geometry.js';

export const fetchSnapshot = (after, step) => fetch(`snapshot?after=${after}&step=${step}`, { cache: 'no-store' });

// The JSON at the front of an answer, and the offset of the data after it.
export function splitSnapshot(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  return [JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length))), 4 + length];
}

// Reverses compressed_disparity().
async function disparities(bytes, frame) {
  const stream = new Response(bytes).body.pipeThrough(new DecompressionStream('deflate'));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const [width, height] = fetchedSize(frame), count = width * height;
  const values = new Int16Array(count);
  for (let i = 0; i < count; ++i) {
    const folded = planes[i] | planes[count + i] << 8;
    values[i] = (i < width ? 0 : values[i - width]) + (folded >>> 1 ^ -(folded & 1));
  }
  return values;
}

// ImageDecoder is faster, but missing in some browsers and over plain HTTP from another host.
async function decodeJpeg(jpeg) {
  if ('ImageDecoder' in window) return (await new ImageDecoder({ data: jpeg, type: 'image/jpeg' }).decode()).image;
  return createImageBitmap(new Blob([jpeg], { type: 'image/jpeg' }));
}

// The disparities (null without a frame) and the left image (null if there is none or it is not a JPEG).
export async function decodeSnapshot(snapshot, buffer, offset) {
  const bytes = new Uint8Array(buffer, offset, snapshot.disparity_bytes);
  const left = new Uint8Array(buffer, offset + snapshot.disparity_bytes, snapshot.left_bytes);
  const [values, image] = await Promise.all([
    snapshot.frame ? disparities(bytes, snapshot.frame) : null,
    snapshot.left_bytes ? decodeJpeg(left).catch(() => null) : null]);
  return { snapshot, values, image };
}
