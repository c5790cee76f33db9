// SPDX-License-Identifier: BSD-3-Clause
// Shows the status of the daemon in words and tables.
const byId = id => document.getElementById(id);
const kMaxAge_ms = 3000;  // the daemon sends a status once a second

function fillTable(id, rows) {
  byId(id).replaceChildren(...rows.map(cells => {
    const row = document.createElement('tr');
    row.append(...cells.map((text, i) => {
      const cell = document.createElement(i ? 'td' : 'th');
      cell.textContent = text === '' || text === undefined || text === null ? '–' : text;
      return cell;
    }));
    return row;
  }));
}

const isNumber = value => value !== undefined && value !== null;
const fixed = (value, digits) => isNumber(value) ? value.toFixed(digits) : '–';
const percent = fraction => isNumber(fraction) ? `${(100 * fraction).toFixed(1)} %` : 'not known';

export function setState(text, className = '') {
  byId('state').textContent = text;
  byId('state').className = 'state ' + className;
}

export const stateText = () => byId('state').textContent;

export function showStatus(s, counts) {
  if (!s) return;
  if (s.age_ms > kMaxAge_ms) setState(`no status for ${Math.round(s.age_ms / 1000)} s`);
  else setState(s.state, s.state);
  byId('reason').textContent = [s.reason, counts.problem].filter(Boolean).join(' ');
  fillTable('daemon', [
    ['matcher', s.matcher],
    ['frames in, out', `${fixed(s.fps_in, 1)} /s, ${fixed(s.fps_out, 1)} /s`],
    ['measured, filled', `${percent(s.measured_fraction)}, ${percent(s.filled_fraction)}`],
    ['no evidence', percent(s.no_evidence_fraction)],
    ['epipolar error', isNumber(s.epipolar_error_px) ? `${fixed(s.epipolar_error_px, 2)} px` : 'not known'],
    ['matching, latency', `${fixed(s.match_ms_median, 2)} ms, ${fixed(s.latency_ms_median, 2)} ms (95 %: ${fixed(s.latency_ms_p95, 2)} ms)`],
    ['synchronization', s.sync_state ? `${s.sync_state}, skew ${fixed(s.sync_skew_ms, 2)} ms, ${s.sync_restarts} restarts` : ''],
    ['pacing', s.paced ? 'on' : 'off'],
    ['pairs made', s.pairs_made],
    ['dropped: superseded', s.dropped_superseded],
    ['dropped: no partner', s.dropped_no_partner],
    ['dropped: time jump', s.dropped_time_jump],
    ['publish errors', s.publish_errors],
    ['rows lost on the way here', `${counts.rows_lost} of ${counts.rows_expected}`],
    ['CPU, memory', `${fixed(s.cpu_percent, 0)} %, ${fixed(s.rss_mb, 0)} MB`],
    ['stereod', `${s.version}, up ${fixed(s.uptime_s, 0)} s`],
  ]);
  const both = (name, of) => [name, of(s.left), of(s.right)];
  fillTable('cameras', [
    both('camera', c => c.name), both('state', c => c.state), both('reason', c => c.reason),
    both('device', c => c.connected || c.device), both('format', c => c.format),
    both('frames', c => `${c.frames}, ${fixed(c.fps, 1)} /s`), both('brightness', c => fixed(c.brightness, 1)),
    both('sequence gaps, decode errors', c => `${c.sequence_gaps}, ${c.decode_errors}`),
    both('incomplete, bad timestamps', c => `${c.incomplete}, ${c.bad_timestamps}`),
    both('superseded, reconnects', c => `${c.superseded}, ${c.reconnects}`),
    both('last fault', c => c.last_fault), both('note', c => c.note),
  ]);
}
