// The live page itself.
#pragma once

#include <string_view>

namespace stereod::calib {

inline constexpr std::string_view kLivePage = R"page(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>Calibrating</title><style>
* { box-sizing:border-box; }
body { margin:0; background:#12181f; color:#eef2f6; font:16px/1.4 system-ui,"DejaVu Sans",sans-serif; }
main { max-width:1400px; margin:0 auto; padding:18px; }
h1 { font-size:40px; margin:0 0 6px; min-height:1.2em; } h1::first-letter { text-transform:uppercase; }
.progress { height:14px; background:#26303b; border-radius:7px; overflow:hidden; }
.progress div { height:100%; background:#3ecf8e; width:0; transition:width .3s; }
p { color:#9fb0c0; margin:8px 0 16px; }
.two { display:grid; grid-template-columns:1fr 1fr; gap:16px; }
figure { margin:0; position:relative; border:4px solid #b3403a; border-radius:10px; overflow:hidden; }
figure.seen { border-color:#3ecf8e; }
figure img, figure svg { display:block; width:100%; } figure svg { position:absolute; inset:0; height:100%; }
figcaption { padding:8px 12px; background:#1b232c; }
.cell { fill:#3ecf8e; fill-opacity:.18; stroke:#3ecf8e; stroke-opacity:.25; } .corner { fill:none; stroke:#ffd23f; stroke-width:2; }
@media (max-width:800px) { .two { grid-template-columns:1fr; } h1 { font-size:28px; } }
</style></head><body><main><h1 id="words">Waiting for the cameras</h1>
<div class="progress"><div id="bar"></div></div><p id="count"></p>
<div class="two"><figure id="left"><div style="position:relative"><img alt="left camera"><svg></svg></div><figcaption></figcaption></figure>
<figure id="right"><div style="position:relative"><img alt="right camera"><svg></svg></div><figcaption></figcaption></figure></div>
</main><script>
const byId = id => document.getElementById(id);
function draw(side, name, s) {
  const figure = byId(name), w = s.width / s.columns, h = s.height / s.rows;
  figure.className = side.corners.length ? 'seen' : '';
  const cells = side.cells.map((n, i) => n ? `<rect class="cell" x="${(i % s.columns) * w}" y="${Math.floor(i / s.columns) * h}" width="${w}" height="${h}"/>` : '');
  const corners = side.corners.map(p => `<circle class="corner" cx="${p[0]}" cy="${p[1]}" r="${s.width / 130}"/>`);
  const svg = figure.querySelector('svg');
  svg.setAttribute('viewBox', `0 0 ${s.width} ${s.height}`);
  svg.innerHTML = cells.join('') + corners.join('');
  figure.querySelector('figcaption').textContent = `${name} camera: ` + (side.corners.length ? 'sees the board' : 'no whole board') +
    `, ${Math.round(100 * side.coverage)} % covered`;
}
async function tick() {
  try {
    const s = await (await fetch('/state')).json();
    if (s.words !== undefined) {
      byId('words').textContent = s.words;
      byId('bar').style.width = Math.min(100, 100 * s.taken / s.wanted) + '%';
      byId('count').textContent = `${s.taken} of ${s.wanted} pairs taken. Pairs are taken by themselves while the board is held still; green cells have been covered.`;
      draw(s.left, 'left', s); draw(s.right, 'right', s);
      for (const name of ['left', 'right']) byId(name).querySelector('img').src = `/${name}.jpg?` + Date.now();
    }
  } catch (e) { byId('words').textContent = 'The session has ended'; }
  setTimeout(tick, 200);
}
tick();
</script></body></html>
)page";

}  // namespace stereod::calib
