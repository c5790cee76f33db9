#include "daemon/capture/stereo_capture.h"

#include <utility>

namespace stereod {
namespace {

void add_counts(CameraStats& stats, const CameraStats& before) {
  stats.frames += before.frames;
  stats.report.sequence_gaps += before.report.sequence_gaps;
  stats.report.reconnects += before.report.reconnects;
  stats.report.decode_errors += before.report.decode_errors;
  stats.report.incomplete += before.report.incomplete;
  stats.report.bad_timestamps += before.report.bad_timestamps;
  stats.report.superseded += before.report.superseded;
}

void add_counts(PairingCounts& counts, const PairingCounts& before) {
  counts.pairs += before.pairs;
  counts.pairs_superseded += before.pairs_superseded;
  counts.left_without_partner += before.left_without_partner;
  counts.right_without_partner += before.right_without_partner;
  counts.frames_before_time_jump += before.frames_before_time_jump;
}

CameraStats stats_of(const CaptureThread& thread) {
  return {thread.report(), thread.frames(), thread.mean_brightness()};
}

}  // namespace

StereoCapture::StereoCapture(const CamerasConfig& config, StereoSource rig)
    : rig_(std::move(rig)), pair_queue_(config.pairing_tolerance_ns(), config.max_skew_ms == 0) {}

StereoCapture::~StereoCapture() { stop(); }

void StereoCapture::start() {
  left_thread_.emplace(Side::kLeft, *rig_.left, pair_queue_);
  right_thread_.emplace(Side::kRight, *rig_.right, pair_queue_);
}

void StereoCapture::stop() noexcept {
  if (left_thread_) left_thread_->stop();
  if (right_thread_) right_thread_->stop();
  pair_queue_.close();
}

void StereoCapture::count_on_from(const StereoCapture& others) { before_ = others.stats(); }

CaptureStats StereoCapture::stats() const {
  CaptureStats stats;
  if (left_thread_) stats.left = stats_of(*left_thread_);
  if (right_thread_) stats.right = stats_of(*right_thread_);
  stats.pairing = pair_queue_.counts();
  add_counts(stats.left, before_.left);
  add_counts(stats.right, before_.right);
  add_counts(stats.pairing, before_.pairing);
  return stats;
}

}  // namespace stereod
