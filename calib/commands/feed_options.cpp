#include "calib/commands/feed_options.h"

#include "calib/base/errors.h"
#include "calib/live/daemon_feed.h"

namespace stereod {

std::string FeedFlags::waiting_words() const {
  return daemon ? "waiting for the daemon's images; is lcm.raw_images true in its stereod.yaml?"
                : "waiting for images of the cameras";
}

void add_feed_options(CLI::App& command, FeedFlags& flags) {
  command.add_option("--config", flags.config,
                     "open the cameras that this stereod.yaml names; stop the daemon first, it holds them");
  command.add_flag("--daemon", flags.daemon,
                   "take the images of the running daemon, which publishes them with lcm.raw_images: true");
  command.add_option("--lcm-url", flags.lcm_url,
                     "with --daemon; default: LCM_DEFAULT_URL, or this machine only");
  command.add_option("--prefix", flags.prefix, "with --daemon: of its channels")->capture_default_str();
}

std::unique_ptr<FrameFeed> open_feed(const FeedFlags& flags) {
  if (flags.daemon == !flags.config.empty()) {
    throw UsageError(
        "say where the images come from: --config FILE opens the cameras, --daemon takes them from stereod "
        "while it runs");
  }
  if (flags.daemon) return std::make_unique<DaemonFeed>(flags.lcm_url, flags.prefix);
  Config config = read_config(flags.config);
  config.calibration.clear();  // an old one may not even be for this image size
  return std::make_unique<CameraFeed>(config);
}

}  // namespace stereod
