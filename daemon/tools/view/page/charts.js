// SPDX-License-Identifier: BSD-3-Clause
// Draws histograms and the obstacle scan from above.

// The distribution of `values`, with their range on the axis.
export function drawHistogram(canvas, values) {
  const c = canvas.getContext('2d'), w = canvas.width, h = canvas.height;
  c.clearRect(0, 0, w, h);
  if (!values.length) return;
  let low = Math.min(...values), high = Math.max(...values);
  const spread = Math.max(high - low, 1);
  low -= 0.05 * spread;
  high = low + 1.1 * spread;
  const bins = new Array(40).fill(0);
  for (const value of values) bins[Math.min(39, Math.floor((value - low) / (high - low) * 40))]++;
  const maximum = Math.max(...bins);
  c.fillStyle = '#5aa9e6';
  bins.forEach((n, i) => c.fillRect(i * w / 40 + 1, (h - 22) * (1 - n / maximum), w / 40 - 2, (h - 22) * n / maximum));
  c.fillStyle = '#a7b1bf';
  c.font = '16px sans-serif';
  c.textAlign = 'left';
  c.fillText(low.toFixed(1), 2, h - 4);
  c.textAlign = 'right';
  c.fillText(high.toFixed(1), w - 2, h - 4);
  c.textAlign = 'center';
  c.fillText('the last ' + values.length + ' frames', w / 2, h - 4);
}

// The robot stands at the bottom and looks up; the arcs are distances.
export function drawScan(canvas, scan) {
  const c = canvas.getContext('2d'), w = canvas.width, h = canvas.height;
  c.clearRect(0, 0, w, h);
  c.font = '16px sans-serif';
  c.fillStyle = '#a7b1bf';
  if (!scan) {
    c.textAlign = 'center';
    c.fillText('no scan: set scan.enabled in stereod.yaml', w / 2, h / 2);
    return;
  }
  const maximum = Math.max(...scan.ranges, 0.1);
  const scale = (h - 30) / maximum, x0 = w / 2, y0 = h - 10;
  const place = (angle, range) => [x0 - Math.sin(angle) * range * scale, y0 - Math.cos(angle) * range * scale];
  scan.ranges.forEach((range, i) => {
    const angle = scan.rad0 + i * scan.radstep;
    c.beginPath();
    c.moveTo(x0, y0);
    c.lineTo(...place(angle - scan.radstep / 2, range || maximum));
    c.lineTo(...place(angle + scan.radstep / 2, range || maximum));
    c.fillStyle = range === 0 ? '#3a2f34' : '#1f3a34';
    c.fill();
    if (!scan.support[i]) return;
    c.strokeStyle = '#ffb454';
    c.lineWidth = 5;
    c.beginPath();
    c.moveTo(...place(angle - scan.radstep / 2, range));
    c.lineTo(...place(angle + scan.radstep / 2, range));
    c.stroke();
  });
  c.lineWidth = 1;
  c.strokeStyle = '#465063';
  c.fillStyle = '#a7b1bf';
  c.textAlign = 'left';
  const spacing = Math.ceil(maximum / 10);
  for (let meters = spacing; meters <= maximum; meters += spacing) {
    c.beginPath();
    c.arc(x0, y0, meters * scale, Math.PI, 2 * Math.PI);
    c.stroke();
    c.fillText(meters + ' m', x0 + 4, y0 - meters * scale - 4);
  }
}
