// SPDX-License-Identifier: BSD-3-Clause
#include "calib/commands/feed_options.h"

#include "calib/base/errors.h"
#include "calib/live/daemon_feed.h"

namespace stereod::calib {

std::string FeedFlags::waiting_message() const {
  return daemon ? "waiting for images of the daemon; they need lcm.raw_images: true in its stereod.yaml"
                : "waiting for images of the cameras";
}

void add_feed_options(CLI::App& command, FeedFlags& flags) {
  command.add_option("--config", flags.config,
                     "open the cameras of this stereod.yaml; stop the daemon first, because it holds them");
  command.add_flag(
      "--daemon", flags.daemon,
      "receive the images of the running daemon; needs lcm.raw_images: true in its stereod.yaml");
  command.add_option("--lcm-url", flags.lcm_url,
                     "with --daemon: LCM URL; default: LCM_DEFAULT_URL, or this machine only");
  command.add_option("--prefix", flags.prefix, "with --daemon: prefix of its channels")
      ->capture_default_str();
}

std::unique_ptr<FrameFeed> open_feed(const FeedFlags& flags) {
  if (flags.daemon == !flags.config.empty()) {
    throw UsageError(
        "give one source of images: --config FILE opens the cameras, --daemon receives the images of the "
        "running stereod");
  }
  if (flags.daemon) return std::make_unique<DaemonFeed>(flags.lcm_url, flags.prefix);
  Config config = read_config(flags.config);
  config.calibration.clear();  // an old calibration may be for another image size
  return std::make_unique<CameraFeed>(config);
}

}  // namespace stereod::calib
