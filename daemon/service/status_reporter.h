// Says once a second how the daemon is.
#pragma once

#include <cstdint>
#include <string>

#include "daemon/lcm/message_bus.h"
#include "daemon/lcm/message_encoder.h"
#include "daemon/pipeline/pipeline.h"
#include "stereod/camera_info_t.hpp"
#include "stereod/status_t.hpp"

namespace stereod {

/// What the daemon is doing, and why, in words.
struct ServiceState {
  std::string name;    ///< starting, waiting_for_cameras, uncalibrated, streaming or degraded
  std::string reason;  ///< empty when streaming
};

/// What has happened lately.
struct Activity {
  bool left_frames = false, right_frames = false;
  bool pairs = false;
  bool published = false;
  bool refused = false;      ///< by the network
  std::string knocked = {};  ///< why the calibration does not fit the cameras any more; empty if it does
};

/// Says when a calibration no longer fits: rows more than a pixel apart, until they are within 0.7 px again;
/// or hardly any point of the left image found in the right one, after it has been otherwise, until some
/// are again.
class CalibrationMonitor {
 public:
  /// The stats of one moment; what is wrong, as a sentence without stats, or empty.
  std::string judge(const EpipolarStats& stats);

 private:
  bool apart_ = false;
  bool was_found_ = false;
  bool lost_ = false;
};

ServiceState judge_state(const Activity& activity, bool calibrated);

/// Publishes status_t and camera_info_t, and logs every change of state once.
class StatusReporter {
 public:
  StatusReporter(Pipeline& pipeline, MessageBus& bus);

  /// From now on about this pipeline, which goes on counting where the one before it ended, and on this bus.
  void follow(Pipeline& pipeline, MessageBus& bus);

  /// A sentence that is added to every reason until it is replaced; empty: nothing.
  void set_remark(const std::string& remark) { remark_ = remark; }

  /// To be called about once a second; the first call says "starting". What it said.
  const status_t& report();

 private:
  void publish_camera_info();
  Activity recent_activity(const PipelineStats& now, std::int64_t now_ns);
  void fill_camera(camera_status_t& message, const CameraStats& now, const CameraStats& before,
                   double seconds);

  Pipeline* pipeline_ = nullptr;  // never null once constructed
  MessageBus* bus_ = nullptr;     // likewise
  MessageEncoder encoder_;
  status_t status_{};
  std::string status_channel_, camera_info_channel_;
  PipelineStats before_;
  // When each last happened.
  struct {
    std::int64_t left = 0, right = 0, pair = 0, publication = 0;
  } last_ns_;
  std::int64_t patience_ns_ = 0;  // how long nothing may happen before it counts as missing
  CalibrationMonitor calibration_monitor_;
  bool first_ = true;
  std::string remark_;
  ServiceState logged_;
  std::int64_t started_ns_, before_ns_;
  double before_cpu_s_;
};

}  // namespace stereod
