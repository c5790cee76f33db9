'use strict';
// Fetches one moment after the other and shows it. The newest is `view.moment`; a person, and the tests, may look.
const byId = id => document.getElementById(id);
const view = { snapshot: null, values: null, paused: false, shown: 0, told: 0, heard: 0, latency: [], skew: [], times: [] };
const cloud = new Cloud(byId('cloud'));
let leftImage = null;  // ImageData of the newest left image

// Deep blue, violet, coral, pale yellow: far to near.
const palette = (() => {
  const stops = [[27, 20, 84], [98, 40, 140], [186, 66, 120], [240, 130, 90], [252, 240, 170]];
  const colors = new Uint8Array(256 * 3);
  for (let i = 0; i < 256; ++i) {
    const at = i / 255 * (stops.length - 1), k = Math.min(Math.floor(at), stops.length - 2);
    for (let j = 0; j < 3; ++j) colors[3 * i + j] = stops[k][j] + (at - k) * (stops[k + 1][j] - stops[k][j]);
  }
  return colors;
})();

const depthOf = (units, f) => {
  const shift = units / f.units_per_pixel + f.camera.disparity_offset;
  return shift > 0 ? f.camera.fx * f.camera.baseline_m / shift : Infinity;
};

// Where a pixel of what is published lies in the rectified image.
const rectifiedX = (frame, x) => frame.left + x * frame.decimation_x;
const rectifiedY = (frame, y) => frame.top + y * frame.decimation_y;

const publishedSize = frame => [Math.ceil(frame.width / frame.step), Math.ceil(frame.height / frame.step)];

// What snapshot_codec.cpp's compressed_disparity() packed.
async function disparities(bytes, frame) {
  const stream = new Response(bytes).body.pipeThrough(new DecompressionStream('deflate'));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const [width, height] = publishedSize(frame), count = width * height;
  const values = new Int16Array(count);
  for (let i = 0; i < count; ++i) {
    const folded = planes[i] | planes[count + i] << 8;
    values[i] = (i < width ? 0 : values[i - width]) + (folded >>> 1 ^ -(folded & 1));
  }
  return values;
}

function momentOf(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  return [JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length))), 4 + length];
}

// The faster way is not there in every browser, nor over plain HTTP from another host.
async function pictureOf(jpeg) {
  if ('ImageDecoder' in window) return (await new ImageDecoder({ data: jpeg, type: 'image/jpeg' }).decode()).image;
  return createImageBitmap(new Blob([jpeg], { type: 'image/jpeg' }));
}

async function decode(snapshot, buffer, at) {
  const bytes = new Uint8Array(buffer, at, snapshot.disparity_bytes);
  const left = new Uint8Array(buffer, at + snapshot.disparity_bytes, snapshot.left_bytes);
  const [values, picture] = await Promise.all([
    snapshot.frame ? disparities(bytes, snapshot.frame) : null,
    snapshot.left_bytes ? pictureOf(left).catch(() => null) : null]);  // anybody may send what is no image
  return { snapshot, values, picture };
}

function drawLeft(picture) {
  byId('no-left').hidden = Boolean(picture);
  if (!picture) {
    leftImage = null;
    byId('left').getContext('2d', { willReadFrequently: true }).clearRect(0, 0, byId('left').width, byId('left').height);
    return;
  }
  const canvas = byId('left'), width = picture.displayWidth || picture.width, height = picture.displayHeight || picture.height;
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
  const context = canvas.getContext('2d', { willReadFrequently: true });
  context.drawImage(picture, 0, 0);
  picture.close();
  leftImage = context.getImageData(0, 0, width, height);
}

// The color of every disparity there can be, for one range of them.
const colors = { least: 0, range: 0, of: new Uint32Array(65536) };

function colorRange(least, range) {
  if (colors.least === least && colors.range === range) return;
  const bytes = new Uint8Array(colors.of.buffer);
  for (let value = -32768; value < 32768; ++value) {
    const o = 4 * (value & 0xFFFF), c = 3 * Math.min(255, Math.max(0, Math.round((value - least) / range * 255)));
    for (let j = 0; j < 3; ++j) bytes[o + j] = value < 0 ? 34 : palette[c + j];
    bytes[o + 3] = 255;
  }
  Object.assign(colors, { least, range });
}

let disparityImage = null;

function drawDisparity(frame, values) {
  const [width, height] = publishedSize(frame), canvas = byId('disparity');
  if (!disparityImage || canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
    disparityImage = new ImageData(width, height);
  }
  colorRange(frame.min_disparity * frame.units_per_pixel, Math.max(frame.disparities * frame.units_per_pixel - 1, 1));
  const pixels = new Uint32Array(disparityImage.data.buffer);
  for (let i = 0; i < values.length; ++i) pixels[i] = colors.of[values[i] & 0xFFFF];
  canvas.getContext('2d', { willReadFrequently: true }).putImageData(disparityImage, 0, 0);
  const far = frame.min_disparity, near = frame.min_disparity + frame.disparities;
  byId('scale').textContent = frame.camera
    ? `${far} px (far) to ${near} px (${depthOf(near * frame.units_per_pixel, frame).toFixed(2)} m)`
    : `${far} px (far) to ${near} px (near), no calibration`;
}

let points = new Float32Array(0);

function drawCloud(frame, values) {
  if (!frame.camera) return;
  const [width, height] = publishedSize(frame);
  const k = Math.max(1, Math.round(Math.min(cloud.spacing / frame.step, width / 100)));
  const most = 4 * Math.ceil(width / k) * Math.ceil(height / k);
  if (points.length < most) points = new Float32Array(most);
  const { fx, fy, cx, cy } = frame.camera;
  let n = 0;
  for (let y = 0; y < height; y += k) {
    for (let x = 0; x < width; x += k) {
      const value = values[y * width + x];
      if (value < 0) continue;
      const z = depthOf(value, frame);
      if (!(z < 20)) continue;
      const px = rectifiedX(frame, x * frame.step), py = rectifiedY(frame, y * frame.step);
      const seen = leftImage && px < leftImage.width && py < leftImage.height;
      points[n] = (px - cx) * z / fx;
      points[n + 1] = (py - cy) * z / fy;
      points[n + 2] = z;
      points[n + 3] = seen ? leftImage.data[4 * (py * leftImage.width + px)] / 255 : 0.8;
      n += 4;
    }
  }
  cloud.show(points.subarray(0, n));
}

function fillTable(id, rows) {
  const table = byId(id);
  table.replaceChildren(...rows.map(cells => {
    const row = document.createElement('tr');
    row.append(...cells.map((text, i) => {
      const cell = document.createElement(i ? 'td' : 'th');
      cell.textContent = text === '' || text === undefined || text === null ? '–' : text;
      return cell;
    }));
    return row;
  }));
}

const fixed = (value, digits) => value === undefined || value === null ? '–' : value.toFixed(digits);

function showStatus(status, counts) {
  if (!status) return;
  const old = status.age_ms > 3000;
  byId('state').textContent = old ? 'no status for ' + Math.round(status.age_ms / 1000) + ' s' : status.state;
  byId('state').className = 'state ' + (old ? '' : status.state);
  byId('reason').textContent = [status.reason, counts.problem].filter(Boolean).join(' ');
  fillTable('daemon', [
    ['matcher', status.matcher],
    ['frames in, out', `${fixed(status.fps_in, 1)} /s, ${fixed(status.fps_out, 1)} /s`],
    ['pairs made', status.pairs_made],
    ['dropped: superseded', status.dropped_superseded],
    ['dropped: no partner', status.dropped_no_partner],
    ['dropped: clock went back', status.dropped_time_jump],
    ['network refusals', status.publish_errors],
    ['rows lost on the way here', `${counts.rows_lost} of ${counts.rows_expected}`],
    ['matching, latency', `${fixed(status.match_ms_median, 2)} ms, ${fixed(status.latency_ms_median, 2)} ms (95 %: ${fixed(status.latency_ms_p95, 2)} ms)`],
    ['CPU, memory', `${fixed(status.cpu_percent, 0)} %, ${fixed(status.rss_mb, 0)} MB`],
    ['stereod', `${status.version}, up ${fixed(status.uptime_s, 0)} s`],
  ]);
  const both = (name, of) => [name, of(status.left), of(status.right)];
  fillTable('cameras', [
    both('camera', c => c.name), both('state', c => c.state), both('reason', c => c.reason),
    both('device', c => c.connected || c.device), both('format', c => c.format),
    both('frames', c => `${c.frames}, ${fixed(c.fps, 1)} /s`), both('brightness', c => fixed(c.brightness, 1)),
    both('gaps, decode errors', c => `${c.sequence_gaps}, ${c.decode_errors}`),
    both('incomplete, bad stamps', c => `${c.incomplete}, ${c.bad_timestamps}`),
    both('superseded, reconnects', c => `${c.superseded}, ${c.reconnects}`),
    both('last fault', c => c.last_fault), both('note', c => c.note),
  ]);
}

function remember(list, value) {
  list.push(value);
  if (list.length > 300) list.shift();
}

function showFrame(frame, values) {
  drawDisparity(frame, values);
  drawCloud(frame, values);
  byId('frame').textContent = frame.frame + (frame.complete ? '' : ` (${frame.rows_received} of ${frame.rows_expected} rows)`);
  remember(view.times, performance.now());
  const recent = view.times.slice(-31);
  if (recent.length > 1) byId('fps').textContent = (1000 * (recent.length - 1) / (recent[recent.length - 1] - recent[0])).toFixed(1);
  const summary = frame.summary;
  if (!summary) return;
  remember(view.latency, summary.latency_us / 1000);
  remember(view.skew, summary.skew_us / 1000);
  byId('latency').textContent = (summary.latency_us / 1000).toFixed(2);
  byId('skew').textContent = (summary.skew_us / 1000).toFixed(2);
  const nearest = byId('nearest');
  const free = summary.nearest_m > 0 ? `${summary.nearest_m.toFixed(2)} m free ahead` : summary.stop ? 'too little is seen ahead' : '';
  nearest.textContent = summary.stop ? `STOP, ${free}` : free;
  nearest.className = summary.stop ? 'stop' : '';
  if (view.shown % 5 === 0) {
    drawHistogram(byId('latency-chart'), view.latency);
    drawHistogram(byId('skew-chart'), view.skew);
  }
}

// The disparity and depth that the newest frame has at a pixel of what is published; null outside.
view.at = (x, y) => {
  const frame = view.snapshot && view.snapshot.frame;
  if (!frame || x < 0 || y < 0 || x >= frame.width || y >= frame.height) return null;
  const [width] = publishedSize(frame);
  const value = view.values[Math.floor(y / frame.step) * width + Math.floor(x / frame.step)];
  return { value, disparity: value < 0 ? null : value / frame.units_per_pixel,
           depth: value < 0 || !frame.camera ? null : depthOf(value, frame) };
};

for (const id of ['left', 'disparity']) {
  byId(id).addEventListener('pointermove', event => {
    const frame = view.snapshot && view.snapshot.frame;
    if (!frame) return;
    const box = event.target.getBoundingClientRect();
    const right = (event.clientX - box.left) / box.width, down = (event.clientY - box.top) / box.height;
    // The left image is all of the rectified image; the disparity may be a part of it.
    view.pointer = id === 'left' && leftImage
      ? [Math.floor((right * leftImage.width - frame.left) / frame.decimation_x),
         Math.floor((down * leftImage.height - frame.top) / frame.decimation_y)]
      : [Math.floor(right * frame.width), Math.floor(down * frame.height)];
    showPointer();
  });
}

function showPointer() {
  if (!view.pointer || !view.snapshot || !view.snapshot.frame) return;
  const found = view.at(...view.pointer), frame = view.snapshot.frame;
  const where = `(${rectifiedX(frame, view.pointer[0])}, ${rectifiedY(frame, view.pointer[1])}): `;
  byId('pointer').textContent = where + (found === null ? 'not published' : found.disparity === null ? 'no disparity'
    : `${found.disparity.toFixed(2)} px` + (found.depth === null ? '' : `, ${found.depth.toFixed(3)} m`));
}

function show({ snapshot, values, picture }) {
  view.heard = performance.now();
  view.snapshot = snapshot;
  view.values = values;
  drawLeft(picture);
  if (snapshot.frame) showFrame(snapshot.frame, values);
  if (view.shown++ % 3 === 0 || !snapshot.frame) drawScan(byId('scan'), snapshot.scan);
  if (performance.now() - view.told > 250 || !snapshot.frame) {  // faster than that nobody reads
    view.told = performance.now();
    showStatus(snapshot.status, snapshot.counts);
  }
  showPointer();
}

byId('pause').addEventListener('click', () => {
  view.paused = !view.paused;
  view.heard = performance.now();
  byId('pause').textContent = view.paused ? 'Go on' : 'Pause';
});

function download(name, blob) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// The disparities in px of the rectified image as PFM (infinite where there is none), as stereo-tap save writes them.
view.pfm = () => {
  const [width, height] = publishedSize(view.snapshot.frame), unitsPerPixel = view.snapshot.frame.units_per_pixel;
  const head = new TextEncoder().encode(`Pf\n${width} ${height}\n-1\n`);
  const body = new Float32Array(width * height);
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const value = view.values[y * width + x];
      body[(height - 1 - y) * width + x] = value < 0 ? Infinity : value / unitsPerPixel;
    }
  }
  return new Blob([head, body]);
};

byId('save').addEventListener('click', () => {
  if (!view.snapshot || !view.snapshot.frame) return;
  const name = 'frame-' + String(view.snapshot.frame.frame).padStart(6, '0');
  download(name + '.pfm', view.pfm());
  byId('disparity').toBlob(blob => download(name + '.png', blob));
  if (leftImage) byId('left').toBlob(blob => download(name + '-left.png', blob));
});

// A stereod that has ended says nothing of it.
setInterval(() => {
  const seconds = Math.round((performance.now() - view.heard) / 1000);
  if (!view.snapshot || view.paused || seconds < 3 || byId('state').textContent.startsWith('connection')) return;
  byId('state').textContent = `nothing from stereod for ${seconds} s`;
  byId('state').className = 'state';
  byId('fps').textContent = '–';
}, 1000);

const pause = ms => new Promise(done => setTimeout(done, ms));

async function run() {
  let after = 0, coming = null;   // the answer on its way
  let last = Promise.resolve();   // the moment before, until it is shown; one is decoded beside it
  const ask = () => fetch(`snapshot?after=${after}&step=${byId('half').checked ? 2 : 1}`, { cache: 'no-store' });
  for (;;) {
    if (view.paused) {
      coming = null;
      await pause(100);
      continue;
    }
    try {
      const answer = await (coming || ask());
      coming = null;
      if (answer.status === 205) after = 0;
      if (answer.status !== 200) {
        if (answer.status !== 204) await pause(500);
        if (!view.snapshot) byId('state').textContent = 'nothing from stereod yet';
        continue;
      }
      const buffer = await answer.arrayBuffer(), [snapshot, at] = momentOf(buffer);
      after = snapshot.number;
      coming = ask();
      const shown = Promise.all([decode(snapshot, buffer, at), last]).then(([decoded]) => view.paused || show(decoded));
      for (const later of [coming, shown]) later.catch(() => {});  // heard of when it is waited for
      await last;
      last = shown;
    } catch (error) {
      byId('state').textContent = 'connection lost, trying again';
      byId('state').className = 'state';
      after = 0;
      coming = null;
      last = Promise.resolve();
      await pause(500);
    }
  }
}
run();
