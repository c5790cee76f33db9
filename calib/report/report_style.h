// SPDX-License-Identifier: BSD-3-Clause
// The report's style sheet.
#pragma once

#include <string_view>

namespace stereod::calib {

inline constexpr std::string_view kReportStyle = R"css(
:root { --ink:#1d2733; --quiet:#687585; --line:#dfe4ea; --paper:#fff; --ground:#f3f5f7; --used:#2f6fb2;
  --held:#e0861a; --good:#1f7a4d; --usable:#a96a00; --again:#b3261e; }
* { box-sizing:border-box; }
body { margin:0; background:var(--ground); color:var(--ink); font:15px/1.5 system-ui,"DejaVu Sans",sans-serif; }
main { max-width:1120px; margin:0 auto; padding:28px 20px 60px; }
header { color:#fff; border-radius:14px; padding:26px 32px; }
header.good { background:var(--good); } header.usable { background:var(--usable); }
header.again { background:var(--again); }
header p { margin:0; opacity:.85; } header ul { margin:6px 0 0; padding-left:1.1em; }
header li { margin:3px 0; }
h1 { margin:2px 0 4px; font-size:46px; line-height:1.1; } h1::first-letter { text-transform:uppercase; }
h2 { margin:0 0 4px; font-size:20px; }
section { background:var(--paper); border:1px solid var(--line); border-radius:14px; padding:22px 28px;
  margin-top:18px; }
section p { margin:0 0 14px; color:var(--quiet); max-width:90ch; }
.stats { display:grid; grid-template-columns:repeat(4,1fr); gap:22px; }
.stat b { display:block; font-size:32px; line-height:1.2; font-variant-numeric:tabular-nums; }
.stat small { font-size:16px; font-weight:400; margin-left:4px; color:var(--quiet); }
.stat span { color:var(--quiet); font-size:13.5px; display:block; }
.two { display:grid; grid-template-columns:1fr 1fr; gap:24px; align-items:center; }
figure { margin:0; } figcaption { margin-top:8px; font-size:14px; }
svg { display:block; width:100%; height:auto; }
.map { border:1px solid var(--line); border-radius:6px; }
.map .ground { fill:#fff; } .map .cell { fill:#b9d3ee; } .map .empty { fill:url(#hatching); }
.map .used { fill:var(--used); }
.pair { border-radius:6px; background:#000; }
.epipolar { stroke-width:1; vector-effect:non-scaling-stroke; stroke-opacity:.75; }
.epipolar.even { stroke:#ffd23f; } .epipolar.odd { stroke:#4fd1ff; }
.corner { fill:none; stroke:#ff3d7f; stroke-width:1.4; vector-effect:non-scaling-stroke; }
.chart .grid { stroke:var(--line); } .chart text { fill:var(--quiet); font-size:13px; }
.chart .left-label { text-anchor:end; } .chart .middle-label { text-anchor:middle; }
.curve { fill:none; stroke:var(--used); stroke-width:2.5; } .dot { fill:var(--used); }
table { border-collapse:collapse; font-variant-numeric:tabular-nums; width:100%; font-size:14px; }
th { text-align:left; font-weight:600; color:var(--quiet); font-size:13px; }
td,th { padding:6px 10px; border-bottom:1px solid var(--line); vertical-align:top; }
tr:last-child td { border-bottom:0; }
.quiet { color:var(--quiet); }
.depth td:nth-child(3) { font-weight:600; }
.bar { display:block; width:130px; height:10px; margin-top:6px; background:var(--ground); border-radius:5px; }
.bar span { display:block; height:10px; border-radius:5px; }
.bar .used { background:var(--used); } .bar .held { background:var(--held); }
tr.out td { background:#fdf1f0; } tr.out em { color:var(--again); font-style:normal; font-weight:600; }
.numbers { width:auto; display:inline-table; margin-right:40px; vertical-align:top; }
footer { color:var(--quiet); font-size:13px; margin-top:16px; text-align:center; }
@media (max-width:800px) { .two,.stats { grid-template-columns:1fr; } }
@media print { body { background:#fff; } section,header { break-inside:avoid; } }
)css";

/// SVG pattern of cells without a corner.
inline constexpr std::string_view kHatching = R"svg(
<svg width="0" height="0" style="position:absolute"><defs>
<pattern id="hatching" width="14" height="14" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">
<rect width="14" height="14" fill="#fff"/><rect width="5" height="14" fill="#e2e6ea"/></pattern></defs></svg>
)svg";

}  // namespace stereod::calib
