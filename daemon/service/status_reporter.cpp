// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/status_reporter.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "daemon/base/clocks.h"
#include "daemon/service/process_usage.h"
#include "daemon/service/version.h"

namespace stereod {
namespace {

constexpr std::size_t kMaxStatus = 16'384;  // encoded status_t [bytes]
constexpr std::size_t kMaxText = 500;       // of each text from outside [bytes]
constexpr double kUnknownTemperature_c = -273;
constexpr double kUnknown = -1;

void append(std::string& text, const std::string& further) {
  if (further.empty()) return;
  if (!text.empty()) text += "; ";
  text += further;
}

/// Appends why a camera does not stream, unless the other camera gave the same reason.
void append_camera_reason(std::string& text, const SourceReport& camera) {
  const std::string reason = camera.reason.substr(0, kMaxText);
  if (!text.ends_with("; " + reason)) append(text, reason);
}

/// Returns how long an event may stay away [ns]: a second, or 2.5 frame periods of slow cameras.
std::int64_t timeout_for(double fps) {
  constexpr double kSecond = 1e9;
  return static_cast<std::int64_t>(fps > 0 ? std::max(kSecond, 2.5 * kSecond / fps) : kSecond);
}

void fill_camera(camera_status_t& message, const CameraStats& now, const CameraStats& before,
                 double seconds) {
  const SourceReport& report = now.report;
  message.state = name_of(report.state);
  message.reason = report.reason.substr(0, kMaxText);
  message.connected = report.device.substr(0, kMaxText);
  message.format = report.format;
  message.note = report.note.substr(0, kMaxText);
  message.last_fault = report.last_fault.substr(0, kMaxText);
  message.last_fault_utime = report.last_fault_ns > 0 ? wall_us_of(report.last_fault_ns) : 0;
  message.mean_brightness = now.mean_brightness;
  message.decode_errors = report.decode_errors;
  message.frames_incomplete = report.incomplete;
  message.frames_bad_timestamp = report.bad_timestamps;
  message.frames_superseded = report.superseded;
  message.reconnects = report.reconnects;
  message.sequence_gaps = report.sequence_gaps;
  message.fps = static_cast<double>(now.frames - before.frames) / seconds;
  message.frames = now.frames;
}

}  // namespace

StatusReporter::StatusReporter(Pipeline& pipeline, MessageBus& bus)
    : encoder_(kMaxStatus),
      started_ns_(monotonic_ns()),
      before_ns_(started_ns_),
      before_cpu_s_(process_cpu_seconds()) {
  status_.version = kVersion;
  status_.left.name = "left";
  status_.right.name = "right";
  status_.cpu_temperature_c = kUnknownTemperature_c;
  status_.yaw_error_sigma_px = kUnknown;
  status_.distance_error_1m_percent = status_.distance_error_3m_percent = kUnknown;
  for (camera_status_t* camera : {&status_.left, &status_.right}) {
    camera->exposure_ms = kUnknown;
    camera->gain = -1;
  }
  follow(pipeline, bus);
}

void StatusReporter::follow(Pipeline& pipeline, MessageBus& bus) {
  pipeline_ = &pipeline;
  bus_ = &bus;
  const Config& config = pipeline.config();
  status_channel_ = config.lcm.prefix + "_STATUS";
  camera_info_channel_ = config.lcm.prefix + "_CAMERA_INFO";
  timeout_ns_ = timeout_for(config.cameras.fps);
  calibration_monitor_ = {};  // the calibration may have changed
  status_.matcher = pipeline.matcher_description();
  status_.paced = config.lcm.pacing > 0 ? 1 : 0;
  status_.left.device = pipeline.rig().left_name.substr(0, kMaxText);
  status_.right.device = pipeline.rig().right_name.substr(0, kMaxText);
  publish_camera_info();
}

void StatusReporter::report() {
  const PipelineStats now = pipeline_->take_stats();
  const std::int64_t now_ns = monotonic_ns();
  const double seconds = std::max(1e-3, static_cast<double>(now_ns - before_ns_) * 1e-9);
  const Activity activity = recent_activity(now, now_ns);
  const bool calibrated = pipeline_->calibration().has_value();
  enter(first_ ? ServiceCondition{} : judge_state(activity, calibrated), now.epipolar);
  status_.utime = wall_us();
  status_.reason = reason_for(activity, now);
  status_.uptime_s = static_cast<double>(now_ns - started_ns_) * 1e-9;
  fill_counts(now, seconds);
  fill_timing(now.published);
  fill_measurements(now);
  fill_process(seconds);
  fill_sync();
  fill_camera(status_.left, now.left, before_.left, seconds);
  fill_camera(status_.right, now.right, before_.right, seconds);
  encoder_.publish(*bus_, status_channel_.c_str(), status_);
  publish_camera_info();
  before_ = now;
  before_ns_ = now_ns;
}

Activity StatusReporter::recent_activity(const PipelineStats& now, std::int64_t now_ns) {
  const auto recent = [&](bool happened, std::int64_t& last_ns) {
    if (happened) last_ns = now_ns;
    return last_ns > 0 && now_ns - last_ns < timeout_ns_;
  };
  Activity activity;
  activity.left_frames = recent(now.left.frames > before_.left.frames, last_.left_frame);
  activity.right_frames = recent(now.right.frames > before_.right.frames, last_.right_frame);
  activity.pairs = recent(now.pairing.pairs > before_.pairing.pairs, last_.pair);
  activity.published = recent(now.published.frames > before_.published.frames, last_.publication);
  activity.refused = now.published.messages_refused > before_.published.messages_refused;
  activity.fit = calibration_monitor_.judge(now.epipolar);
  return activity;
}

// A reason may hold numbers that change every second, so only a change of the cause is logged.
void StatusReporter::enter(const ServiceCondition& condition, const EpipolarStats& epipolar) {
  if (!std::exchange(first_, false) && condition == condition_) return;
  condition_ = condition;
  status_.state = name_of(condition.state);
  const std::string reason = describe(condition.cause, epipolar);
  spdlog::info("state: {}{}{}", status_.state, reason.empty() ? "" : ": ", reason);
}

std::string StatusReporter::reason_for(const Activity& activity, const PipelineStats& now) const {
  std::string reason = describe(condition_.cause, now.epipolar);
  if (condition_.state == ServiceState::kWaitingForCameras) {
    if (!activity.left_frames) append_camera_reason(reason, now.left.report);
    if (!activity.right_frames) append_camera_reason(reason, now.right.report);
  }
  append(reason, remark_.substr(0, kMaxText));
  return reason;
}

void StatusReporter::fill_counts(const PipelineStats& now, double seconds) {
  status_.fps_in = static_cast<double>(now.pairing.pairs - before_.pairing.pairs) / seconds;
  status_.fps_out = static_cast<double>(now.published.frames - before_.published.frames) / seconds;
  status_.frames_published = now.published.frames;
  status_.pairs_made = now.pairing.pairs;
  status_.pairs_dropped_superseded = now.pairing.pairs_superseded;
  status_.frames_dropped_no_partner = now.pairing.left_without_partner + now.pairing.right_without_partner;
  status_.frames_dropped_time_jump = now.pairing.frames_before_time_jump;
  status_.publish_errors = now.published.messages_refused;
}

void StatusReporter::fill_timing(const PublisherStats& published) {
  status_.skew_ms_median = published.skew_ms.percentile(0.5);
  status_.skew_ms_p95 = published.skew_magnitude_ms.percentile(0.95);
  status_.skew_ms_max = published.skew_magnitude_ms.percentile(1);
  status_.latency_ms_median = published.latency_ms.percentile(0.5);
  status_.latency_ms_p95 = published.latency_ms.percentile(0.95);
  status_.latency_ms_max = published.latency_ms.percentile(1);
  status_.match_ms_median = published.match_ms.percentile(0.5);
}

void StatusReporter::fill_measurements(const PipelineStats& now) {
  const auto& error = now.epipolar.epipolar_error;
  status_.epipolar_error_px = error ? error->epipolar_error_px : 0;
  status_.epipolar_points = error ? static_cast<std::int32_t>(error->points) : 0;
  status_.epipolar_probe_percent = 100 * now.epipolar.cost_share;
  const frame_t& latest = now.published.latest;
  status_.measured_fraction = static_cast<double>(latest.measured_fraction);
  status_.filled_fraction = static_cast<double>(latest.filled_fraction);
  status_.no_evidence_fraction = static_cast<double>(latest.no_evidence_fraction);
}

void StatusReporter::fill_process(double seconds) {
  const double cpu_s = process_cpu_seconds();
  status_.cpu_percent = 100 * (cpu_s - before_cpu_s_) / seconds;
  status_.rss_mb = process_rss_mb();
  before_cpu_s_ = cpu_s;
}

void StatusReporter::fill_sync() {
  const auto& cameras = pipeline_->rig().cameras;
  if (!cameras) return;
  const v4l2::PhaseSyncReport sync = cameras->sync_report();
  status_.sync_state = v4l2::name_of(sync.state);
  status_.sync_skew_ms = sync.skew_ms;
  status_.sync_restarts = sync.restarts;
}

void StatusReporter::publish_camera_info() {
  const MatcherOptions& matcher = pipeline_->config().matcher;
  const Size size = pipeline_->rig().left->frame_size();
  camera_info_t info{};
  info.utime = wall_us();
  info.width = size.width;
  info.height = size.height;
  info.min_disparity = matcher.min_disparity;
  info.disparities = matcher.disparities;
  if (const auto& calibration = pipeline_->calibration()) {
    const RectifiedProjection& left = calibration->left.projection;
    info.calibrated = 1;
    info.fx = left.fx;
    info.fy = left.fy;
    info.cx = left.cx;
    info.cy = left.cy;
    info.baseline_m = calibration->baseline_m;
    info.disparity_offset = calibration->right.projection.cx - left.cx;
    info.calibration_id = calibration->id;
  }
  encoder_.publish(*bus_, camera_info_channel_.c_str(), info);
}

}  // namespace stereod
