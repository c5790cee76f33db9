// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/capture/stereo_capture.h"

#include <utility>

namespace stereod {
namespace {

void add_counts(CameraStats& stats, const CameraStats& previous) {
  stats.frames += previous.frames;
  stats.report.sequence_gaps += previous.report.sequence_gaps;
  stats.report.reconnects += previous.report.reconnects;
  stats.report.decode_errors += previous.report.decode_errors;
  stats.report.incomplete += previous.report.incomplete;
  stats.report.bad_timestamps += previous.report.bad_timestamps;
  stats.report.superseded += previous.report.superseded;
}

void add_counts(PairingCounts& counts, const PairingCounts& previous) {
  counts.pairs += previous.pairs;
  counts.pairs_superseded += previous.pairs_superseded;
  counts.left_without_partner += previous.left_without_partner;
  counts.right_without_partner += previous.right_without_partner;
  counts.frames_before_time_jump += previous.frames_before_time_jump;
}

CameraStats stats_of(const CaptureThread& thread) {
  return {thread.report(), thread.frames(), thread.mean_brightness()};
}

}  // namespace

StereoCapture::StereoCapture(const CamerasConfig& config, StereoSource source)
    : source_(std::move(source)), pair_queue_(config.pairing_tolerance_ns(), config.max_skew_ms == 0) {}

StereoCapture::~StereoCapture() { stop(); }

void StereoCapture::start() {
  left_thread_.emplace(Side::kLeft, *source_.left, pair_queue_);
  right_thread_.emplace(Side::kRight, *source_.right, pair_queue_);
}

void StereoCapture::stop() noexcept {
  if (left_thread_) left_thread_->stop();
  if (right_thread_) right_thread_->stop();
  pair_queue_.close();
}

void StereoCapture::count_on_from(const StereoCapture& previous) { previous_ = previous.stats(); }

CaptureStats StereoCapture::stats() const {
  CaptureStats stats;
  if (left_thread_) stats.left = stats_of(*left_thread_);
  if (right_thread_) stats.right = stats_of(*right_thread_);
  stats.pairing = pair_queue_.counts();
  add_counts(stats.left, previous_.left);
  add_counts(stats.right, previous_.right);
  add_counts(stats.pairing, previous_.pairing);
  return stats;
}

}  // namespace stereod
