// SPDX-License-Identifier: BSD-3-Clause
// The files of the live page.
#pragma once

#include <string_view>

namespace stereod::calib {

inline constexpr std::string_view kLivePageHtml = R"page(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>Calibrating</title><link rel="stylesheet" href="/live.css"></head>
<body><main><h1 id="instruction">Waiting for the cameras</h1>
<div class="progress"><div id="bar"></div></div><p id="count"></p>
<div class="two">
<figure id="left"><div class="image"><img alt="left camera"><svg></svg></div><figcaption></figcaption></figure>
<figure id="right"><div class="image"><img alt="right camera"><svg></svg></div><figcaption></figcaption></figure>
</div></main><script src="/live.js"></script></body></html>
)page";

inline constexpr std::string_view kLivePageCss = R"page(* { box-sizing:border-box; }
body { margin:0; background:#12181f; color:#eef2f6; font:16px/1.4 system-ui,"DejaVu Sans",sans-serif; }
main { max-width:1400px; margin:0 auto; padding:18px; }
h1 { font-size:40px; margin:0 0 6px; min-height:1.2em; } h1::first-letter { text-transform:uppercase; }
.progress { height:14px; background:#26303b; border-radius:7px; overflow:hidden; }
.progress div { height:100%; background:#3ecf8e; width:0; transition:width .3s; }
p { color:#9fb0c0; margin:8px 0 16px; }
.two { display:grid; grid-template-columns:1fr 1fr; gap:16px; }
figure { margin:0; border:4px solid #b3403a; border-radius:10px; overflow:hidden; }
figure.board-seen { border-color:#3ecf8e; }
.image { position:relative; }
.image img, .image svg { display:block; width:100%; } .image svg { position:absolute; inset:0; height:100%; }
figcaption { padding:8px 12px; background:#1b232c; }
.cell { fill:#3ecf8e; fill-opacity:.18; stroke:#3ecf8e; stroke-opacity:.25; }
.corner { fill:none; stroke:#ffd23f; stroke-width:2; }
@media (max-width:800px) { .two { grid-template-columns:1fr; } h1 { font-size:28px; } }
)page";

inline constexpr std::string_view kLivePageJs = R"page('use strict';
const byId = id => document.getElementById(id);
function draw(camera, name, s) {
  const figure = byId(name), w = s.width / s.columns, h = s.height / s.rows;
  figure.className = camera.corners.length ? 'board-seen' : '';
  const cells = camera.cells.map((n, i) => n ? `<rect class="cell" x="${(i % s.columns) * w}" y="${Math.floor(i / s.columns) * h}" width="${w}" height="${h}"/>` : '');
  const corners = camera.corners.map(p => `<circle class="corner" cx="${p[0]}" cy="${p[1]}" r="${s.width / 130}"/>`);
  const svg = figure.querySelector('svg');
  svg.setAttribute('viewBox', `0 0 ${s.width} ${s.height}`);
  svg.innerHTML = cells.join('') + corners.join('');
  figure.querySelector('figcaption').textContent = `${name} camera: ` + (camera.corners.length ? 'board found' : 'no whole board') +
    `, ${Math.round(100 * camera.coverage)} % covered`;
}
async function update() {
  try {
    const s = await (await fetch('/state')).json();
    if (s.words !== undefined) {
      byId('instruction').textContent = s.words;
      byId('bar').style.width = Math.min(100, 100 * s.taken / s.wanted) + '%';
      byId('count').textContent = `${s.taken} of ${s.wanted} pairs taken. A pair is taken whenever the board is held still. Green cells are covered.`;
      draw(s.left, 'left', s); draw(s.right, 'right', s);
      for (const name of ['left', 'right']) byId(name).querySelector('img').src = `/${name}.jpg?` + Date.now();
    }
  } catch (e) { byId('instruction').textContent = 'The session has ended'; }
  setTimeout(update, 200);
}
update();
)page";

}  // namespace stereod::calib
