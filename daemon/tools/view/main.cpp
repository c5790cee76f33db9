// SPDX-License-Identifier: BSD-3-Clause
// stereo-view: shows what stereod publishes as a page.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "daemon/base/stop_signals.h"
#include "daemon/lcm/url.h"
#include "daemon/tools/tap/tap.h"
#include "daemon/tools/view/live_view.h"
#include "daemon/tools/view/view_feed.h"
#include "daemon/tools/view/view_server.h"

namespace stereod::tools {
namespace {

int run(int argc, char** argv) {
  TapOptions tap;
  ViewServerOptions server_options;
  CLI::App app("Serves a page on this machine that shows what stereod publishes.", "stereo-view");
  app.add_option(
      "--lcm-url", tap.lcm_url,
      "LCM URL (default: LCM_DEFAULT_URL of the environment, else " + std::string(kDefaultLcmUrl) + ")");
  app.add_option("--prefix", tap.prefix, "prefix of the channels, lcm.prefix of the daemon")
      ->capture_default_str();
  app.add_option("--port", server_options.port, "port of the page on 127.0.0.1; 0: any free port")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  app.add_option("--allow-host", server_options.allowed_hosts,
                 "host name accepted besides localhost, for a proxy in front of the page; repeatable");
  app.footer(
      "The page is served on this machine only. From another machine run\n"
      "ssh -L 8091:127.0.0.1:8091 ROBOT, then open http://127.0.0.1:8091/ there. The left image needs\n"
      "lcm.left_image: jpeg in stereod.yaml, the obstacle scan scan.enabled: true.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "stereo-view: %s (see stereo-view --help)\n", error.what());
    return kFailed;
  }
  StopSignals stop;
  LiveView view;
  ViewFeed feed(tap.lcm_url, tap.prefix, view);
  const ViewServer server(view, server_options);
  std::printf("http://127.0.0.1:%d/\n", server.port());
  std::fflush(stdout);
  while (!stop.arrived()) feed.run_once();
  return kSuccess;
}

}  // namespace
}  // namespace stereod::tools

int main(int argc, char** argv) {
  try {
    return stereod::tools::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stereo-view: %s\n", error.what());
    return stereod::tools::kFailed;
  }
}
