// SPDX-License-Identifier: BSD-3-Clause
// The daemon: a pipeline, its status, and reloads of the configuration.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "daemon/lcm/message_bus.h"
#include "daemon/pipeline/pipeline.h"
#include "daemon/service/service_manager.h"
#include "daemon/service/status_reporter.h"

namespace stereod {

/// Runs the pipeline of one configuration file. One thread calls its functions.
///
/// Call tick() periodically (about 20 Hz). The service is ready for systemd once a frame was published or it
/// reported that it waits for cameras. It pings the watchdog once a second, but only if frames were published
/// since the last ping or the matcher is idle waiting for a pair; a timer alone never feeds it.
class Service {
 public:
  /// Opens the message bus of a URL; throws BusError.
  using OpenBus = std::function<std::unique_ptr<MessageBus>(const std::string& url)>;

  /// Starts capturing and publishing. @p file is the file that @p config was read from; reload() reads it
  /// again.
  /// @throws FileError if the configuration cannot work, BusError if the network cannot be used.
  Service(Config config, std::filesystem::path file, OpenBus open_bus);

  /// Publishes the status and notifies systemd when due.
  void tick();

  /// Reads the file again and applies it. Cameras are restarted only if their section changed in more than
  /// controls and exposure. If the new configuration cannot work, keeps the previous one and reports the
  /// reason in the log, in every status and to systemd, until a reload succeeds.
  void reload();

  /// Returns true once a recording has played to its end.
  bool finished() const noexcept { return pipeline_->finished(); }

  /// Stops the cameras and the pipeline.
  void stop();

 private:
  void adopt(const Config& config);
  void report();
  void update_remark();

  const std::filesystem::path file_;
  const OpenBus open_bus_;
  Config config_;
  ServiceManager manager_;
  std::unique_ptr<MessageBus> bus_;
  std::unique_ptr<Pipeline> pipeline_;
  std::unique_ptr<StatusReporter> reporter_;
  std::string reload_problem_, scheduling_problem_;  // empty: none
  std::int64_t next_report_ns_ = 0;
  std::int64_t published_at_ping_ = 0;  // frames_published at the latest watchdog ping
};

}  // namespace stereod
