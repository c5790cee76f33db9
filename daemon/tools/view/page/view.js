// SPDX-License-Identifier: BSD-3-Clause
// Fetches one snapshot after the other and shows it.
import { drawHistogram, drawScan } from './charts.js';
import { Cloud } from './cloud.js';
import { publishedX, publishedY, rectifiedX, rectifiedY, valueAt } from './geometry.js';
import { drawDisparity, drawLeft, leftImage } from './images.js';
import { pointsOf } from './points.js';
import { saveFrame } from './save.js';
import { decodeSnapshot, fetchSnapshot, splitSnapshot } from './snapshot.js';
import { setState, showStatus, stateText } from './status.js';

const byId = id => document.getElementById(id);
const kHistory = 300;        // frames in the histograms
const kStatusPeriod_ms = 250;
const kMaxSilence_s = 3;

// State of the page; global for the browser's console and the tests.
const view = globalThis.view = {
  snapshot: null,            // JSON of the latest snapshot
  values: null,              // its disparities
  pointer: null,             // published pixel under the pointer
  paused: false,
  shown: 0,                  // snapshots shown
  shownTime: 0, statusTime: 0,  // of the latest snapshot and status, ms
  latency: [], skew: [], times: [],
  at: (x, y) => view.snapshot && valueAt(view.snapshot.frame, view.values, x, y),
};
const cloud = view.cloud = new Cloud(byId('cloud'));

function remember(list, value) {
  list.push(value);
  if (list.length > kHistory) list.shift();
}

function showObstacles(summary) {
  const nearest = byId('nearest');
  const free = summary.nearest_m > 0 ? `${summary.nearest_m.toFixed(2)} m free ahead` : summary.stop ? 'too little is seen ahead' : '';
  nearest.textContent = summary.stop ? `STOP, ${free}` : free;
  nearest.className = summary.stop ? 'stop' : '';
}

function showSummary(summary) {
  remember(view.latency, summary.latency_us / 1000);
  remember(view.skew, summary.skew_us / 1000);
  byId('latency').textContent = (summary.latency_us / 1000).toFixed(2);
  byId('skew').textContent = (summary.skew_us / 1000).toFixed(2);
  showObstacles(summary);
  if (view.shown % 5 === 0) {
    drawHistogram(byId('latency-chart'), view.latency);
    drawHistogram(byId('skew-chart'), view.skew);
  }
}

function showFrame(frame, values) {
  drawDisparity(frame, values);
  if (frame.camera) cloud.show(pointsOf(frame, values, leftImage, cloud.spacing));
  byId('frame').textContent = frame.frame + (frame.complete ? '' : ` (${frame.rows_received} of ${frame.rows_expected} rows)`);
  remember(view.times, performance.now());
  const recent = view.times.slice(-31);
  if (recent.length > 1) byId('fps').textContent = (1000 * (recent.length - 1) / (recent[recent.length - 1] - recent[0])).toFixed(1);
  if (frame.summary) showSummary(frame.summary);
}

function showPointer() {
  if (!view.pointer || !view.snapshot || !view.snapshot.frame) return;
  const found = view.at(...view.pointer), frame = view.snapshot.frame;
  const place = `(${rectifiedX(frame, view.pointer[0])}, ${rectifiedY(frame, view.pointer[1])}): `;
  byId('pointer').textContent = place + (found === null ? 'not published' : found.disparity === null ? 'not measured'
    : `${found.disparity.toFixed(2)} px` + (found.depth === null ? '' : `, ${found.depth.toFixed(3)} m`));
}

function show({ snapshot, values, image }) {
  view.shownTime = performance.now();
  view.snapshot = snapshot;
  view.values = values;
  drawLeft(image);
  if (snapshot.frame) showFrame(snapshot.frame, values);
  if (view.shown++ % 3 === 0 || !snapshot.frame) drawScan(byId('scan'), snapshot.scan);
  if (performance.now() - view.statusTime > kStatusPeriod_ms || !snapshot.frame) {
    view.statusTime = performance.now();
    showStatus(snapshot.status, snapshot.counts);
  }
  showPointer();
}

for (const id of ['left', 'disparity']) {
  byId(id).addEventListener('pointermove', event => {
    const frame = view.snapshot && view.snapshot.frame;
    if (!frame) return;
    const box = event.target.getBoundingClientRect();
    const right = (event.clientX - box.left) / box.width, down = (event.clientY - box.top) / box.height;
    // The left image is the whole rectified image; the disparities may be a region of it.
    view.pointer = id === 'left' && leftImage
      ? [publishedX(frame, right * leftImage.width), publishedY(frame, down * leftImage.height)]
      : [Math.floor(right * frame.width), Math.floor(down * frame.height)];
    showPointer();
  });
}

byId('pause').addEventListener('click', () => {
  view.paused = !view.paused;
  view.shownTime = performance.now();
  byId('pause').textContent = view.paused ? 'Resume' : 'Pause';
});

byId('save').addEventListener('click', () => {
  if (!view.snapshot || !view.snapshot.frame) return;
  saveFrame(view.snapshot.frame, view.values, byId('disparity'), leftImage ? byId('left') : null);
});

// A daemon that has ended sends nothing that would say so.
setInterval(() => {
  const seconds = Math.round((performance.now() - view.shownTime) / 1000);
  if (!view.snapshot || view.paused || seconds < kMaxSilence_s || stateText().startsWith('connection')) return;
  setState(`nothing from stereod for ${seconds} s`);
  byId('fps').textContent = '–';
}, 1000);

const sleep = ms => new Promise(done => setTimeout(done, ms));

// Three snapshots are under way at once: one is shown, one is decoded, one is fetched.
async function run() {
  let after = 0, pending = null;  // number of the latest snapshot; the answer under way
  let last = Promise.resolve();   // resolved once the previous snapshot is shown
  const ask = () => fetchSnapshot(after, byId('half').checked ? 2 : 1);
  for (;;) {
    if (view.paused) {
      pending = null;
      await sleep(100);
      continue;
    }
    try {
      const answer = await (pending || ask());
      pending = null;
      if (answer.status === 205) after = 0;  // the server was restarted
      if (answer.status !== 200) {
        if (answer.status !== 204) await sleep(500);
        if (!view.snapshot) setState('nothing from stereod yet');
        continue;
      }
      const buffer = await answer.arrayBuffer(), [snapshot, offset] = splitSnapshot(buffer);
      after = snapshot.number;
      pending = ask();
      const shown = Promise.all([decodeSnapshot(snapshot, buffer, offset), last]).then(([decoded]) => view.paused || show(decoded));
      for (const promise of [pending, shown]) promise.catch(() => {});  // rejections are handled where they are awaited
      await last;
      last = shown;
    } catch (error) {
      setState('connection lost, trying again');
      after = 0;
      pending = null;
      last = Promise.resolve();
      await sleep(500);
    }
  }
}
run();
