// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/view/snapshot_codec.h"

#include <zlib.h>

#include <cstdint>
#include <limits>

#include "daemon/tools/view/json_text.h"

namespace stereod::tools {
namespace {

JsonObject json_of(const camera_status_t& c) {
  JsonObject json;
  json.add("name", c.name).add("device", c.device).add("connected", c.connected).add("format", c.format);
  json.add("state", c.state).add("reason", c.reason).add("note", c.note).add("last_fault", c.last_fault);
  json.add("fps", c.fps).add("brightness", c.mean_brightness).add("frames", c.frames);
  json.add("sequence_gaps", c.sequence_gaps).add("decode_errors", c.decode_errors);
  json.add("incomplete", c.frames_incomplete).add("bad_timestamps", c.frames_bad_timestamp);
  json.add("superseded", c.frames_superseded).add("reconnects", c.reconnects);
  return json;
}

/// Returns @p value if it is known, else NaN, which JSON shows as null.
double known_or_nan(bool is_known, double value) {
  return is_known ? value : std::numeric_limits<double>::quiet_NaN();
}

JsonObject json_of(const status_t& s, std::int64_t age_ms) {
  JsonObject json;
  json.add("age_ms", age_ms).add("state", s.state).add("reason", s.reason).add("version", s.version);
  json.add("matcher", s.matcher)
      .add("uptime_s", s.uptime_s)
      .add("fps_in", s.fps_in)
      .add("fps_out", s.fps_out);
  json.add("pairs_made", s.pairs_made).add("frames_published", s.frames_published);
  json.add("dropped_superseded", s.pairs_dropped_superseded);
  json.add("dropped_no_partner", s.frames_dropped_no_partner);
  json.add("dropped_time_jump", s.frames_dropped_time_jump).add("publish_errors", s.publish_errors);
  json.add("measured_fraction", s.measured_fraction).add("filled_fraction", s.filled_fraction);
  json.add("no_evidence_fraction", known_or_nan(s.no_evidence_fraction >= 0, s.no_evidence_fraction));
  json.add("epipolar_error_px", known_or_nan(s.epipolar_points > 0, s.epipolar_error_px));
  json.add("sync_state", s.sync_state)
      .add("sync_skew_ms", s.sync_skew_ms)
      .add("sync_restarts", s.sync_restarts);
  json.add("paced", s.paced != 0);
  json.add("skew_ms_median", s.skew_ms_median).add("latency_ms_median", s.latency_ms_median);
  json.add("latency_ms_p95", s.latency_ms_p95).add("match_ms_median", s.match_ms_median);
  json.add("cpu_percent", s.cpu_percent).add("rss_mb", s.rss_mb);
  json.add("left", json_of(s.left)).add("right", json_of(s.right));
  return json;
}

JsonObject json_of(const planar_lidar_t& scan) {
  JsonObject json;
  json.add("utime", scan.utime).add("ranges", scan.ranges).add("support", scan.intensities);
  json.add("rad0", static_cast<double>(scan.rad0)).add("radstep", static_cast<double>(scan.radstep));
  return json;
}

JsonObject json_of(const frame_t& f) {
  JsonObject json;
  json.add("measured_fraction", static_cast<double>(f.measured_fraction)).add("skew_us", f.skew_us);
  json.add("filled_fraction", static_cast<double>(f.filled_fraction));
  json.add("no_evidence_fraction",
           known_or_nan(f.no_evidence_fraction >= 0, static_cast<double>(f.no_evidence_fraction)));
  json.add("left_sequence", f.left_sequence).add("right_sequence", f.right_sequence);
  json.add("capture_to_start_us", f.capture_to_start_us).add("rectify_us", f.rectify_us);
  json.add("match_us", f.match_us).add("filter_us", f.filter_us).add("publish_us", f.publish_us);
  json.add("latency_us", f.latency_us).add("stop", f.stop != 0);
  json.add("nearest_m", static_cast<double>(f.nearest_m));
  return json;
}

JsonObject json_of(const CameraGeometry& c) {
  JsonObject json;
  json.add("fx", c.fx).add("fy", c.fy).add("cx", c.cx).add("cy", c.cy).add("baseline_m", c.baseline_m);
  json.add("disparity_offset", c.disparity_offset);
  return json;
}

JsonObject json_of(const ReceptionCounts& c) {
  JsonObject json;
  json.add("frames_complete", c.frames_complete).add("frames_incomplete", c.frames_incomplete);
  json.add("frames_missing", c.frames_missing)
      .add("rows_lost", c.rows_lost)
      .add("rows_expected", c.rows_expected);
  json.add("ignored", c.messages_ignored).add("problem", describe_problems(c));
  return json;
}

JsonObject json_of(const StereoFrame& frame, int step) {
  JsonObject json;
  json.add("frame", frame.frame).add("utime", frame.utime);
  json.add("width", frame.disparity.width()).add("height", frame.disparity.height()).add("step", step);
  json.add("left", frame.grid.left).add("top", frame.grid.top);
  json.add("decimation_x", frame.grid.decimation_x).add("decimation_y", frame.grid.decimation_y);
  json.add("units_per_pixel", frame.units_per_pixel).add("min_disparity", frame.min_disparity);
  json.add("disparities", frame.disparities).add("complete", frame.complete());
  json.add("rows_received", frame.rows_received).add("rows_expected", frame.rows_expected);
  if (frame.summary) json.add("summary", json_of(*frame.summary));
  if (frame.camera) json.add("camera", json_of(*frame.camera));
  return json;
}

/// Packs and compresses disparities. Each value becomes its difference to the value above it, folded so that small
/// differences of either sign are small numbers (0, −1, 1, −2 … become 0, 1, 2, 3 …). All low bytes precede all high bytes.
/// Compresses to a third of the size of the plain values, in half the time.
std::string compressed_disparity(const DisparityMap& map, int step) {
  const std::size_t columns = (static_cast<std::size_t>(map.width()) + step - 1) / step;
  const std::size_t rows = (static_cast<std::size_t>(map.height()) + step - 1) / step;
  std::string bytes(2 * columns * rows, '\0');
  std::size_t i = 0;
  for (int y = 0; y < map.height(); y += step) {
    for (int x = 0; x < map.width(); x += step, ++i) {
      const auto difference = static_cast<std::int16_t>(map.at(x, y) - (y == 0 ? 0 : map.at(x, y - step)));
      const auto folded = static_cast<std::uint16_t>(difference << 1 ^ difference >> 15);
      bytes[i] = static_cast<char>(folded & 0xFF);
      bytes[columns * rows + i] = static_cast<char>(folded >> 8);
    }
  }
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  const auto* in = reinterpret_cast<const Bytef*>(bytes.data());
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, in, bytes.size(), 1) != Z_OK) return {};
  out.resize(size);
  return out;
}

}  // namespace

std::string encode_snapshot(const Snapshot& snapshot, int step) {
  std::string disparity;
  JsonObject json;
  json.add("number", snapshot.number);
  if (snapshot.frame) {
    disparity = compressed_disparity(snapshot.frame->disparity, step);
    json.add("frame", json_of(*snapshot.frame, step));
  }
  if (snapshot.scan) json.add("scan", json_of(*snapshot.scan));
  if (snapshot.status) json.add("status", json_of(*snapshot.status, snapshot.status_age_ms));
  json.add("counts", json_of(snapshot.counts)).add("left_utime", snapshot.left_utime);
  json.add("disparity_bytes", static_cast<std::int64_t>(disparity.size()));
  json.add("left_bytes", static_cast<std::int64_t>(snapshot.left_jpeg.size()));
  const std::string text = json.text();
  std::string out;
  for (unsigned shift = 0; shift < 32; shift += 8) out += static_cast<char>(text.size() >> shift & 0xFF);
  out += text;
  out += disparity;
  out.append(snapshot.left_jpeg.begin(), snapshot.left_jpeg.end());
  return out;
}

}  // namespace stereod::tools
