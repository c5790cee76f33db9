// The daemon: a pipeline, what it says about itself, and what becomes of it when the configuration changes.
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

/// Whoever runs it calls tick() every so often, twenty times a second say, and reload() when asked to. To
/// systemd it is ready once a pair was published or it has declared that it waits for cameras. It is alive,
/// once a second, if more was published since it last said so, or if there is nothing to do until the cameras
/// bring a pair: a clock alone never makes it so.
class Service {
 public:
  /// Opens the bus that a URL names; throws BusError.
  using OpenBus = std::function<std::unique_ptr<MessageBus>(const std::string& url)>;

  /// Starts at once. `file` is what `config` was read from and what reload() reads. Throws FileError and
  /// BusError.
  Service(Config config, std::filesystem::path file, OpenBus open_bus);

  /// Does what is due.
  void tick();

  /// Reads the file again and goes on with what it says. Cameras are set up anew only if their section has
  /// changed in more than controls and exposure. If the file cannot work, all stays as it is and the reason
  /// is told in the log, in every status and to systemd, until a reload succeeds.
  void reload();

  /// The recording has played to its end.
  bool finished() const noexcept { return pipeline_->finished(); }

  /// Ends the cameras and all that follows.
  void stop();

 private:
  void adopt(const Config& config);
  void report();
  void remark();

  const std::filesystem::path file_;
  const OpenBus open_bus_;
  Config config_;
  ServiceManager manager_;
  std::unique_ptr<MessageBus> bus_;
  std::unique_ptr<Pipeline> pipeline_;
  std::unique_ptr<StatusReporter> reporter_;
  std::string reload_problem_, scheduling_problem_;  // what is wrong; empty if nothing
  std::int64_t next_report_ns_ = 0;
  std::int64_t published_when_alive_ = 0;
};

}  // namespace stereod
