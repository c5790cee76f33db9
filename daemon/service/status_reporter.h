// SPDX-License-Identifier: BSD-3-Clause
// Publishes the status of the daemon once a second.
#pragma once

#include <cstdint>
#include <string>

#include "daemon/lcm/message_bus.h"
#include "daemon/lcm/message_encoder.h"
#include "daemon/pipeline/calibration_monitor.h"
#include "daemon/pipeline/pipeline.h"
#include "daemon/service/service_state.h"
#include "stereod/camera_info_t.hpp"
#include "stereod/status_t.hpp"

namespace stereod {

/// Publishes status_t and camera_info_t, and logs every change of state once. One thread.
class StatusReporter {
 public:
  StatusReporter(Pipeline& pipeline, MessageBus& bus);

  /// Reports about @p pipeline on @p bus from now on. Both must outlive the reporter or the next call. The
  /// counters of @p pipeline must continue those of the previous one (Pipeline::take_over()).
  void follow(Pipeline& pipeline, MessageBus& bus);

  /// Sets text that is appended to the reason of every status; empty: none.
  void set_remark(const std::string& remark) { remark_ = remark; }

  /// Publishes the status and the camera info. Call it about once a second; the first call reports kStarting.
  void report();

  /// Returns the state and the message of the latest report().
  ServiceState state() const { return condition_.state; }
  const status_t& message() const { return status_; }

 private:
  /// Times of the latest events [CLOCK_MONOTONIC ns]; 0: never.
  struct LastEvents {
    std::int64_t left_frame = 0, right_frame = 0, pair = 0, publication = 0;
  };

  Activity recent_activity(const PipelineStats& now, std::int64_t now_ns);
  void enter(const ServiceCondition& condition, const EpipolarStats& epipolar);
  std::string reason_for(const Activity& activity, const PipelineStats& now) const;
  void fill_counts(const PipelineStats& now, double seconds);
  void fill_timing(const PublisherStats& published);
  void fill_measurements(const PipelineStats& now);
  void fill_process(double seconds);
  void fill_sync();
  void publish_camera_info();

  Pipeline* pipeline_ = nullptr;  // never null after construction
  MessageBus* bus_ = nullptr;     // never null after construction
  MessageEncoder encoder_;
  status_t status_{};
  std::string status_channel_, camera_info_channel_;
  PipelineStats before_;  // at the previous report
  LastEvents last_;
  std::int64_t timeout_ns_ = 0;  // without an event for so long, it counts as missing
  CalibrationMonitor calibration_monitor_;
  bool first_ = true;
  std::string remark_;
  ServiceCondition condition_;
  std::int64_t started_ns_, before_ns_;
  double before_cpu_s_;
};

}  // namespace stereod
