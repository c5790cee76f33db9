// SPDX-License-Identifier: BSD-3-Clause
// The page in a browser: stereod, stereo-view and Chromium as a user runs them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <thread>

#include <yaml-cpp/yaml.h>

#include "daemon/client/stereod_client.h"
#include "daemon/imagefile/read_image.h"
#include "tests/support/chromium.h"
#include "tests/support/network.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_directory.h"

namespace stereod::tools {
namespace {

constexpr const char* kUrl = "udpm://239.255.76.67:17668?ttl=0";  // a port of the tests' own
const std::filesystem::path kBin = STEREOD_BIN_DIR;

class Browser : public testing::Test {
 protected:
  void SetUp() override {
    if (const auto why = why_no_multicast()) GTEST_SKIP() << *why;
    chromium_ = Chromium::program();
    if (!chromium_) GTEST_SKIP() << "no Chromium here: apt-get install chromium";
    std::ofstream(config_)
        << "cameras: {source: synthetic, fps: 20, synthetic: {width: 320, height: 240}}\n"
        << "scan: {enabled: true, ground: fixed, camera_height_m: 0.45, stop_distance_m: 0.8}\n"
        << "lcm: {url: \"" << kUrl << "\", prefix: WEB, left_image: jpeg}\n";
  }

  /// Waits for at most three minutes: a browser without a graphics card is slow.
  static bool wait_until(const std::function<bool()>& is_so) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(3);
    while (!is_so()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return true;  // evaluated once: a moving image may return to an earlier state
  }

  ChildProgram start_stereod() {
    return {kBin / "stereod", {"--config", config_.string()}, directory_.path()};
  }

  TemporaryDirectory directory_;
  const std::filesystem::path config_ = directory_ / "stereod.yaml";
  std::optional<std::filesystem::path> chromium_;
};

std::string page_of(const ChildProgram& view) {
  const std::string text = view.out_so_far();
  return text.substr(0, text.find('\n'));
}

/// The button saves three files: the exact disparities, their image and the left image.
void expect_saved_frame(Chromium& browser, const StereoFrame& sent) {
  // The page keeps what it would write to the disk.
  browser.evaluate(
      "(() => { window.saved = []; window.kept = new Map();"
      " URL.createObjectURL = blob => { const url = 'blob:' + kept.size; kept.set(url, blob); return url; };"
      " HTMLAnchorElement.prototype.click = function() { saved.push([this.download, kept.get(this.href)]); };"
      " document.getElementById('save').click(); })()");
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (browser.evaluate("saved.length") != "3" && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  char number[32];
  std::snprintf(number, sizeof number, "frame-%06lld", static_cast<long long>(sent.frame));
  const std::string name = number;
  EXPECT_EQ(browser.evaluate("saved.map(s => s[0]).sort().join(' ')"),
            name + "-left.png " + name + ".pfm " + name + ".png");
  const std::string of = "(async () => { const b = new Uint8Array(await saved.find(s => s[0] === '";
  for (const char* suffix : {".png", "-left.png"}) {
    EXPECT_EQ(
        browser.evaluate(
            of + name + suffix +
            "')[1].arrayBuffer()); return String.fromCharCode(...b.slice(1, 4)) + (b.length > 5000); })()"),
        "PNGtrue")
        << suffix;
  }
  EXPECT_EQ(
      browser.evaluate(of + name +
                       ".pfm')[1].arrayBuffer()); return new TextDecoder().decode(b.slice(0, 14)); })()"),
      "Pf\n320 240\n-1\n");
  const YAML::Node values =
      YAML::Load(browser.evaluate(of + name +
                                  ".pfm')[1].arrayBuffer());"
                                  " return JSON.stringify(Array.from(new Float32Array(b.slice(14).buffer), v "
                                  "=> v === Infinity ? -1 : v)); })()"));
  ASSERT_EQ(values.size(), std::size_t{320 * 240});
  int different = 0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      const float px = sent.disparity_px(x, y);
      different += values[(239 - y) * 320 + x].as<float>() != (std::isnan(px) ? -1.0F : px) ? 1 : 0;
    }
  }
  EXPECT_EQ(different, 0);
}

TEST_F(Browser, Stream_ShownAsOnTheWire) {
  std::map<std::int64_t, StereoFrame> wire;
  StereoClient::Options options;
  options.url = kUrl;
  options.prefix = "WEB";
  options.latest_only = false;
  options.queue_messages = 100'000;  // what arrives while the browser is busy
  StereoClient client(options);
  client.on_frame([&](StereoFrame&& frame) { wire.emplace(frame.frame, std::move(frame)); });

  ChildProgram view(kBin / "stereo-view", {"--lcm-url", kUrl, "--prefix", "WEB", "--port", "0"},
                    directory_.path());
  ASSERT_TRUE(wait_until([&] { return page_of(view).rfind("http://127.0.0.1:", 0) == 0; }));
  ChildProgram stereod = start_stereod();
  Chromium browser(*chromium_, directory_.path());
  browser.open(page_of(view), 1400, 1500);
  const auto shows_frames = [&](int more) {
    const std::string before = browser.evaluate("typeof view === 'undefined' ? 0 : view.shown");
    return wait_until([&] {
      client.handle(1);
      return std::stoi(browser.evaluate("typeof view === 'undefined' ? 0 : view.shown")) >=
             std::stoi(before) + more;
    });
  };
  ASSERT_TRUE(shows_frames(20));

  // Compares a complete frame of the page with the same frame from the wire.
  const std::string whole_and_streaming =
      "view.snapshot.frame && view.snapshot.frame.complete && document.getElementById('state').textContent";
  ASSERT_TRUE(wait_until([&] {
    client.handle(1);
    browser.evaluate("view.paused = true");
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    if (browser.evaluate(whole_and_streaming) == "streaming") return true;
    browser.evaluate("view.paused = false");
    return false;
  }));
  const YAML::Node snapshot = YAML::Load(browser.evaluate("JSON.stringify(view.snapshot)"));
  const YAML::Node frame = snapshot["frame"];
  const auto number = frame["frame"].as<std::int64_t>();
  ASSERT_TRUE(wait_until([&] {
    client.handle(10);
    return wire.count(number) == 1;
  }));
  const StereoFrame& sent = wire.at(number);
  ASSERT_TRUE(sent.summary && sent.camera);
  EXPECT_EQ(frame["utime"].as<std::int64_t>(), sent.utime);
  EXPECT_EQ(frame["summary"]["skew_us"].as<int>(), sent.summary->skew_us);
  EXPECT_EQ(frame["summary"]["latency_us"].as<int>(), sent.summary->latency_us);
  EXPECT_FLOAT_EQ(frame["summary"]["nearest_m"].as<float>(), sent.summary->nearest_m);
  EXPECT_EQ(frame["summary"]["stop"].as<bool>(), sent.summary->stop != 0);
  char latency[32];
  std::snprintf(latency, sizeof latency, "%.2f", sent.summary->latency_us / 1000.0);
  EXPECT_EQ(browser.evaluate("document.getElementById('latency').textContent"), latency);
  EXPECT_EQ(browser.evaluate("document.getElementById('frame').textContent"), std::to_string(number));
  EXPECT_EQ(browser.evaluate("document.getElementById('state').textContent"), "streaming");
  const YAML::Node values = YAML::Load(browser.evaluate("JSON.stringify(Array.from(view.values))"));
  ASSERT_EQ(values.size(), std::size_t{320 * 240});
  int different = 0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x)
      different += values[y * 320 + x].as<int>() != sent.disparity.at(x, y) ? 1 : 0;
  }
  EXPECT_EQ(different, 0);
  // Depth under the pointer.
  int looked_at = 0;
  for (int y = 10; y < 240; y += 40) {
    for (int x = 10; x < 320; x += 40) {
      if (!std::isfinite(sent.depth_m(x, y))) continue;
      ++looked_at;
      const std::string depth =
          browser.evaluate("view.at(" + std::to_string(x) + "," + std::to_string(y) + ").depth");
      EXPECT_FLOAT_EQ(std::stof(depth), sent.depth_m(x, y));
    }
  }
  EXPECT_GT(looked_at, 10);
  expect_saved_frame(browser, sent);

  // Every image changes.
  browser.evaluate("view.paused = false");
  for (const char* id : {"left", "disparity", "cloud", "latency-chart"}) {
    const std::string content = "document.getElementById('" + std::string(id) + "').toDataURL()";
    const std::string first = browser.evaluate(content);
    EXPECT_GT(first.size(), 2000U) << id;
    EXPECT_TRUE(wait_until([&] {
      client.handle(1);
      return browser.evaluate(content) != first;
    })) << id;
  }
  EXPECT_THAT(browser.evaluate("document.getElementById('cameras').textContent"),
              testing::HasSubstr("streaming"));
  if (const char* keep = std::getenv("STEREO_SCREENSHOTS")) {
    browser.screenshot(std::filesystem::path(keep) / "stereo-view.png");
  }
}

TEST_F(Browser, DaemonAndServerRestarted_Reconnects) {
  const std::string port = std::to_string(20000 + ::getpid() % 20000);
  const std::vector<std::string> arguments{"--lcm-url", kUrl, "--prefix", "WEB", "--port", port};
  Chromium browser(*chromium_, directory_.path());
  const auto state = [&] { return browser.evaluate("document.getElementById('state').textContent"); };
  ChildProgram stereod = start_stereod();
  {
    ChildProgram view(kBin / "stereo-view", arguments, directory_.path());
    ASSERT_TRUE(wait_until([&] { return !page_of(view).empty(); })) << view.err_so_far();
    browser.open(page_of(view), 800, 600);
    ASSERT_TRUE(wait_until(
        [&] { return browser.evaluate("document.title") == "stereo-view" && state() == "streaming"; }));
  }
  EXPECT_TRUE(wait_until([&] { return state() == "connection lost, trying again"; }));
  const int shown = std::stoi(browser.evaluate("view.shown"));
  ChildProgram view(kBin / "stereo-view", arguments, directory_.path());
  EXPECT_TRUE(wait_until([&] { return std::stoi(browser.evaluate("view.shown")) > shown + 10; }));
  EXPECT_TRUE(wait_until([&] { return state() == "streaming"; }));
  stereod.send(SIGKILL);
  EXPECT_TRUE(wait_until([&] { return state().rfind("nothing from stereod for ", 0) == 0; }));
}

}  // namespace
}  // namespace stereod::tools
