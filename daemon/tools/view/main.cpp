// stereo-view: what stereod sees, as a page.
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

    namespace stereod {
  namespace {

  int run(int argc, char** argv) {
    TapOptions tap;
    ViewServerOptions server_options;
    CLI::App app("Shows what stereod publishes as a page on this machine.", "stereo-view");
    app.add_option("--lcm-url", tap.lcm_url,
                   "where to listen (default: the environment's LCM_DEFAULT_URL, else " +
                       std::string(kDefaultLcmUrl) + ")");
    app.add_option("--prefix", tap.prefix, "what the daemon's channels begin with")->capture_default_str();
    app.add_option("--port", server_options.port, "of the page on 127.0.0.1; 0: any free one")
        ->check(CLI::Range(0, 65535))
        ->capture_default_str();
    app.add_option(
        "--allow-host", server_options.allowed_hosts,
        "a name by which the page may be asked for, for a proxy in front of it; may be given again");
    app.footer(
        "The page is for this machine only. From another one: ssh -L 8091:127.0.0.1:8091 ROBOT, then\n"
        "http://127.0.0.1:8091/ there. The left image needs lcm.left_image in the daemon's configuration, the\n"
        "obstacle scan needs scan.enabled.");
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
    return kAllWell;
  }

  }  // namespace
}  // namespace stereod

int main(int argc, char** argv) {
  try {
    return stereod::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stereo-view: %s\n", error.what());
    return stereod::kFailed;
  }
}
