// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/service.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>

#include "core/base/text.h"
#include "daemon/base/clocks.h"
#include "daemon/lcm/url.h"
#include "daemon/service/checks.h"
#include "daemon/service/log.h"
#include "daemon/service/status_line.h"
#include "daemon/service/version.h"

namespace stereod {
namespace {

constexpr std::int64_t kReportPeriod_ns = 1'000'000'000;

// Ignores settings that streaming cameras can change.
bool same_cameras(CamerasConfig a, const CamerasConfig& b) {
  a.v4l2.exposure = b.v4l2.exposure;
  a.v4l2.controls = b.v4l2.controls;
  a.v4l2.left_controls = b.v4l2.left_controls;
  a.v4l2.right_controls = b.v4l2.right_controls;
  return a == b;
}

std::string describe(const Pipeline& pipeline) {
  const Size size = pipeline.rig().left->frame_size();
  const Config& config = pipeline.config();
  return fmt::format("{} {}, matcher {}, channels {}_*", name_of(config.cameras.source), to_string(size),
                     pipeline.matcher_description(), config.lcm.prefix);
}

}  // namespace

Service::Service(Config config, std::filesystem::path file, OpenBus open_bus)
    : file_(std::move(file)), open_bus_(std::move(open_bus)), config_(std::move(config)) {
  StereoSource source = open_checked_source(config_, file_);
  bus_ = open_bus_(config_.lcm.url);
  pipeline_ = std::make_unique<Pipeline>(config_, std::move(source), *bus_);
  reporter_ = std::make_unique<StatusReporter>(*pipeline_, *bus_);
  spdlog::info("stereod {}: {}", kVersion, describe(*pipeline_));
  next_report_ns_ = monotonic_ns();
}

void Service::tick() {
  if (pipeline_->frames_published() > 0) manager_.ready();
  const std::int64_t now = monotonic_ns();
  if (now < next_report_ns_) return;
  next_report_ns_ = std::max(next_report_ns_ + kReportPeriod_ns, now);
  report();
}

// The remark is appended to every status.
void Service::update_remark() {
  const std::string problem = pipeline_->scheduling_problem();
  if (problem != scheduling_problem_ && !problem.empty()) spdlog::warn("{}", problem);
  scheduling_problem_ = problem;
  const bool both = !reload_problem_.empty() && !problem.empty();
  reporter_->set_remark(reload_problem_ + (both ? "; " : "") + problem);
}

void Service::report() {
  update_remark();
  reporter_->report();
  const status_t& status = reporter_->message();
  manager_.status(status_line(reporter_->state(), status));
  if (reporter_->state() == ServiceState::kWaitingForCameras) manager_.ready();
  if (status.frames_published > published_at_ping_ || pipeline_->waits_for_cameras()) {
    published_at_ping_ = status.frames_published;
    manager_.alive();
  }
}

void Service::reload() {
  manager_.reloading();
  try {
    adopt(read_config(file_));
    reload_problem_.clear();
  } catch (const std::exception& error) {
    reload_problem_ = std::string("reload failed, keeping the previous configuration: ") + error.what();
    spdlog::error("{}", reload_problem_);
  }
  manager_.reloaded();
}

// Everything that can fail comes before the old pipeline is touched.
void Service::adopt(const Config& config) {
  check_config(config, file_);
  const bool keep_cameras = same_cameras(config_.cameras, config.cameras);
  std::shared_ptr<StereoCapture> cameras = pipeline_->cameras();
  std::optional<Calibration> calibration;
  if (keep_cameras) {
    check_frame_size(config, file_, cameras->rig().left->frame_size());
    calibration = calibration_for(config, cameras->rig());
    check_calibration(config, file_, calibration);
  } else {
    StereoSource source = open_checked_source(config, file_);
    calibration = source.calibration;
    cameras = std::make_shared<StereoCapture>(config.cameras, std::move(source));
  }
  std::unique_ptr<MessageBus> bus;
  if (effective_lcm_url(config.lcm.url) != effective_lcm_url(config_.lcm.url)) {
    bus = open_bus_(config.lcm.url);
  }
  auto pipeline = std::make_unique<Pipeline>(config, std::move(calibration), cameras, bus ? *bus : *bus_);

  if (keep_cameras && cameras->rig().cameras && config.cameras != config_.cameras) {
    cameras->rig().cameras->set_controls(config.cameras.v4l2);
  }
  pipeline->take_over(*pipeline_);
  reporter_->follow(*pipeline, bus ? *bus : *bus_);
  pipeline_ = std::move(pipeline);
  if (bus) bus_ = std::move(bus);
  config_ = config;
  set_log_level(config.log_level);
  spdlog::info("configuration reloaded, cameras {}: {}", keep_cameras ? "kept running" : "restarted",
               describe(*pipeline_));
}

void Service::stop() {
  manager_.stopping();
  if (finished()) reporter_->report();  // includes the last frames
  pipeline_->stop();
}

}  // namespace stereod
