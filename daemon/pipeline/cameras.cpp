#include "daemon/pipeline/cameras.h"

#include <utility>

namespace stereod {
namespace {

void add_counts(CameraFigures& figures, const CameraFigures& before) {
  figures.frames += before.frames;
  figures.report.sequence_gaps += before.report.sequence_gaps;
  figures.report.reconnects += before.report.reconnects;
  figures.report.decode_errors += before.report.decode_errors;
  figures.report.incomplete += before.report.incomplete;
  figures.report.bad_stamps += before.report.bad_stamps;
  figures.report.superseded += before.report.superseded;
}

void add_counts(PairingCounts& counts, const PairingCounts& before) {
  counts.pairs += before.pairs;
  counts.pairs_superseded += before.pairs_superseded;
  counts.left_without_partner += before.left_without_partner;
  counts.right_without_partner += before.right_without_partner;
  counts.frames_before_time_jump += before.frames_before_time_jump;
}

CameraFigures figures_of(const CaptureThread& thread) {
  return {thread.report(), thread.frames(), thread.mean_brightness()};
}

}  // namespace

Cameras::Cameras(const CamerasConfig& config, Rig rig)
    : rig_(std::move(rig)), desk_(config.pairing_tolerance_ns(), config.max_skew_ms == 0) {}

Cameras::~Cameras() { stop(); }

void Cameras::start() {
  left_thread_.emplace(Side::kLeft, *rig_.left, desk_);
  right_thread_.emplace(Side::kRight, *rig_.right, desk_);
}

void Cameras::stop() noexcept {
  if (left_thread_) left_thread_->stop();
  if (right_thread_) right_thread_->stop();
  desk_.close();
}

void Cameras::count_on_from(const Cameras& others) { before_ = others.figures(); }

CamerasFigures Cameras::figures() const {
  CamerasFigures figures;
  if (left_thread_) figures.left = figures_of(*left_thread_);
  if (right_thread_) figures.right = figures_of(*right_thread_);
  figures.pairing = desk_.counts();
  add_counts(figures.left, before_.left);
  add_counts(figures.right, before_.right);
  add_counts(figures.pairing, before_.pairing);
  return figures;
}

}  // namespace stereod
