#include "daemon/service/status_reporter.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "daemon/base/clocks.h"
#include "daemon/service/process_usage.h"
#include "daemon/service/version.h"

namespace stereod {
namespace {

constexpr std::size_t kMaxStatus = 16'384;
constexpr std::size_t kMaxText = 500;

std::string missing_cameras(const Activity& activity) {
  if (activity.left_frames && activity.right_frames) return {};
  if (activity.left_frames) return "no frames from the right camera";
  if (activity.right_frames) return "no frames from the left camera";
  return "no frames from either camera";
}

// What both cameras say is said once.
void add_reason(std::string& reason, const SourceReport& camera) {
  const std::string further = "; " + camera.reason.substr(0, kMaxText);
  if (!camera.reason.empty() && !reason.ends_with(further)) reason += further;
}

// A second, or two and a half frames of a slow camera.
std::int64_t patience_for(double fps) {
  constexpr double kSecond = 1e9;
  return static_cast<std::int64_t>(fps > 0 ? std::max(kSecond, 2.5 * kSecond / fps) : kSecond);
}

}  // namespace

std::string CalibrationMonitor::judge(const EpipolarStats& stats) {
  constexpr double kApart_px = 1, kTogether_px = 0.7;
  constexpr std::size_t kEnough = 100;
  const double hardly_any = std::max(0.01, stats.usual_share / 8),
               some = std::max(0.05, stats.usual_share / 3);
  constexpr const char* kRemedy =
      "; was a camera knocked? 'stereo-calibrate check' measures it, if so calibrate again";
  if (stats.epipolar_error) {
    apart_ = stats.epipolar_error->epipolar_error_px > (apart_ ? kTogether_px : kApart_px);
    was_found_ = true;
  }
  // Also while too few points are found to tell: only rows that are seen to lie side by side are a reason to
  // think so.
  if (apart_) return std::string("rows of the rectified images do not lie side by side any more") + kRemedy;
  if (stats.searched >= kEnough) lost_ = was_found_ && stats.found_share < (lost_ ? some : hardly_any);
  if (lost_) {
    return std::string(
               "hardly anything of the left image is found in the right one any more; is something before "
               "a "
               "lens or very near") +
           kRemedy;
  }
  return {};
}

ServiceState judge_state(const Activity& activity, bool calibrated) {
  const std::string missing = missing_cameras(activity);
  if (!missing.empty()) return {"waiting_for_cameras", missing};
  if (!activity.published) {
    if (!activity.pairs) {
      return {"degraded",
              "both cameras give frames, but never near enough in time to be a pair; raise "
              "cameras.max_skew_ms or "
              "give both the same rate"};
    }
    return {"degraded", "pairs are made, but none was published lately"};
  }
  if (activity.refused) return {"degraded", "the network refused messages"};
  if (!calibrated)
    return {"uncalibrated", "no calibration is configured, so the images are matched unrectified"};
  if (!activity.knocked.empty()) return {"degraded", activity.knocked};
  return {"streaming", ""};
}

StatusReporter::StatusReporter(Pipeline& pipeline, MessageBus& bus)
    : encoder_(kMaxStatus),
      started_ns_(monotonic_ns()),
      before_ns_(started_ns_),
      before_cpu_s_(process_cpu_seconds()) {
  status_.version = kVersion;
  status_.left.name = "left";
  status_.right.name = "right";
  status_.cpu_temperature_c = -273;
  status_.yaw_error_sigma_px = -1;
  status_.distance_error_1m_percent = status_.distance_error_3m_percent = -1;
  for (camera_status_t* camera : {&status_.left, &status_.right}) camera->exposure_ms = camera->gain = -1;
  follow(pipeline, bus);
}

void StatusReporter::follow(Pipeline& pipeline, MessageBus& bus) {
  pipeline_ = &pipeline;
  bus_ = &bus;
  const Config& config = pipeline.config();
  status_channel_ = config.lcm.prefix + "_STATUS";
  camera_info_channel_ = config.lcm.prefix + "_CAMERA_INFO";
  patience_ns_ = patience_for(config.cameras.fps);
  calibration_monitor_ = {};  // it may be another calibration
  status_.matcher = pipeline.matcher_description();
  status_.paced = config.lcm.pacing > 0 ? 1 : 0;
  status_.left.device = pipeline.rig().left_name.substr(0, kMaxText);
  status_.right.device = pipeline.rig().right_name.substr(0, kMaxText);
}

const status_t& StatusReporter::report() {
  const PipelineStats now = pipeline_->take_stats();
  const std::int64_t now_ns = monotonic_ns();
  const double seconds = std::max(1e-3, static_cast<double>(now_ns - before_ns_) * 1e-9);
  const double cpu_s = process_cpu_seconds();
  Activity activity = recent_activity(now, now_ns);
  activity.knocked = calibration_monitor_.judge(now.alignment);
  const bool calibrated = pipeline_->calibration().has_value();
  const ServiceState state = std::exchange(first_, false)
                                 ? ServiceState{"starting", "waiting for the first frames"}
                                 : judge_state(activity, calibrated);
  if (state.name != logged_.name || state.reason != logged_.reason) {
    spdlog::info("state: {}{}{}", state.name, state.reason.empty() ? "" : ": ", state.reason);
    logged_ = state;
  }

  const auto& epipolar_error = now.alignment.epipolar_error;
  status_.utime = wall_us();
  status_.state = state.name;
  status_.reason = state.reason;
  // The cameras have logged their own reasons.
  if (state.name == "waiting_for_cameras") {
    if (!activity.left_frames) add_reason(status_.reason, now.left.report);
    if (!activity.right_frames) add_reason(status_.reason, now.right.report);
  }
  if (!activity.knocked.empty() && state.reason == activity.knocked && epipolar_error) {
    char figure[64];
    std::snprintf(figure, sizeof figure, " (now %.1f px apart, by %zu points)",
                  epipolar_error->epipolar_error_px, epipolar_error->points);
    status_.reason += figure;
  }
  if (!remark_.empty()) {
    if (!status_.reason.empty()) status_.reason += "; ";
    status_.reason += remark_.substr(0, kMaxText);
  }
  status_.uptime_s = static_cast<double>(now_ns - started_ns_) * 1e-9;
  status_.fps_in = static_cast<double>(now.pairing.pairs - before_.pairing.pairs) / seconds;
  status_.fps_out = static_cast<double>(now.published.frames - before_.published.frames) / seconds;
  status_.frames_published = now.published.frames;
  status_.pairs_made = now.pairing.pairs;
  status_.pairs_dropped_superseded = now.pairing.pairs_superseded;
  status_.frames_dropped_no_partner = now.pairing.left_without_partner + now.pairing.right_without_partner;
  status_.frames_dropped_time_jump = now.pairing.frames_before_time_jump;
  status_.publish_errors = now.published.messages_refused;
  status_.skew_ms_median = now.published.skew_ms.percentile(0.5);
  status_.skew_ms_p95 = now.published.skew_magnitude_ms.percentile(0.95);
  status_.skew_ms_max = now.published.skew_magnitude_ms.percentile(1);
  status_.latency_ms_median = now.published.latency_ms.percentile(0.5);
  status_.latency_ms_p95 = now.published.latency_ms.percentile(0.95);
  status_.latency_ms_max = now.published.latency_ms.percentile(1);
  status_.match_ms_median = now.published.match_ms.percentile(0.5);
  status_.epipolar_error_px = epipolar_error ? epipolar_error->epipolar_error_px : 0;
  status_.epipolar_points = epipolar_error ? static_cast<std::int32_t>(epipolar_error->points) : 0;
  status_.epipolar_probe_percent = 100 * now.alignment.cost_share;
  status_.measured_fraction = now.published.measured_fraction;
  status_.filled_fraction = now.published.filled_fraction;
  status_.no_evidence_fraction = now.published.no_evidence_fraction;
  status_.cpu_percent = 100 * (cpu_s - before_cpu_s_) / seconds;
  status_.rss_mb = process_rss_mb();
  if (const auto& cameras = pipeline_->rig().cameras) {
    const v4l2::PhaseSyncReport sync = cameras->sync_report();
    status_.sync_state = v4l2::name_of(sync.state);
    status_.sync_skew_ms = sync.skew_ms;
    status_.sync_restarts = sync.restarts;
  }
  fill_camera(status_.left, now.left, before_.left, seconds);
  fill_camera(status_.right, now.right, before_.right, seconds);
  encoder_.publish(*bus_, status_channel_.c_str(), status_);
  publish_camera_info();

  before_ = now;
  before_ns_ = now_ns;
  before_cpu_s_ = cpu_s;
  return status_;
}

Activity StatusReporter::recent_activity(const PipelineStats& now, std::int64_t now_ns) {
  const auto happened_lately = [&](bool happened, std::int64_t& last_ns) {
    if (happened) last_ns = now_ns;
    return last_ns > 0 && now_ns - last_ns < patience_ns_;
  };
  Activity activity;
  activity.left_frames = happened_lately(now.left.frames > before_.left.frames, last_ns_.left);
  activity.right_frames = happened_lately(now.right.frames > before_.right.frames, last_ns_.right);
  activity.pairs = happened_lately(now.pairing.pairs > before_.pairing.pairs, last_ns_.pair);
  activity.published = happened_lately(now.published.frames > before_.published.frames, last_ns_.publication);
  activity.refused = now.published.messages_refused > before_.published.messages_refused;
  return activity;
}

void StatusReporter::fill_camera(camera_status_t& message, const CameraStats& now, const CameraStats& before,
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
