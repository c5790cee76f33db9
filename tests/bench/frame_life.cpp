// SPDX-License-Identifier: BSD-3-Clause
// Draws the life of one frame, from the exposure until a receiver has all of it: from the times in the
// messages of a running stereod and the arrival times of the rows. Must run on the daemon's machine.
//
//   frame_life OUT.svg TITLE [PREFIX [FRAMES]]
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "daemon/client/stereod_client.h"

namespace stereod {
namespace {

/// A frame and the arrival time of each block of its rows [µs since the Unix epoch].
struct Life {
  frame_t summary{};
  std::vector<std::int64_t> came;
  std::vector<int> first_row;
  std::int64_t whole = 0;
};

std::int64_t now_us() {
  using std::chrono::microseconds;
  return std::chrono::duration_cast<microseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::vector<Life> listen(const std::string& prefix, std::size_t count) {
  StereoClient::Options options;
  options.prefix = prefix;
  options.latest_only = false;
  StereoClient client(options);
  std::map<std::int64_t, Life> open;
  std::vector<Life> lives;
  client.on_rows([&](const RowBlock& block) {
    Life& life = open[block.message().frame];
    life.came.push_back(now_us());
    life.first_row.push_back(block.message().first_row);
  });
  client.on_frame([&](StereoFrame&& frame) {
    Life life = std::move(open[frame.frame]);
    open.erase(open.begin(), open.upper_bound(frame.frame));
    if (!frame.complete()) return;
    life.summary = *frame.summary;
    life.whole = now_us();
    lives.push_back(std::move(life));
  });
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (lives.size() < count) {
    if (std::chrono::steady_clock::now() > deadline) throw std::runtime_error("no frames on " + prefix);
    client.handle(100);
  }
  return lives;
}

/// Returns the frame of median latency.
Life median_of(std::vector<Life> lives) {
  const auto middle = lives.begin() + static_cast<std::ptrdiff_t>(lives.size() / 2);
  std::nth_element(lives.begin(), middle, lives.end(),
                   [](const Life& a, const Life& b) { return a.summary.latency_us < b.summary.latency_us; });
  return *middle;
}

/// Bars along a time axis, 0 at the later exposure.
class Drawing {
 public:
  explicit Drawing(double max_ms) : ms_px_(540 / max_ms) {}

  void bar(const std::string& label, const char* color, double from_ms, double to_ms) {
    text(10, y_ + 14, label);
    add("<rect x='%.1f' y='%d' width='%.1f' height='18' fill='%s'/>", x(from_ms), y_,
        std::max((to_ms - from_ms) * ms_px_, 0.5), color);
    char span[64];
    std::snprintf(span, sizeof span, "%.2f ms", to_ms - from_ms);
    text(x(to_ms) + 5, y_ + 14, span);
    y_ += 26;
  }
  /// Draws ticks at heights of 0 (top of the lane) to 1 (bottom).
  void ticks(const std::string& label, const std::vector<std::pair<double, double>>& times_and_heights) {
    constexpr int kHeight = 60;
    text(10, y_ + 14, label);
    for (const auto& [ms, height] : times_and_heights) {
      add("<rect x='%.1f' y='%.1f' width='2' height='4' fill='#c0392b'/>", x(ms), y_ + height * kHeight);
    }
    y_ += kHeight + 14;
  }
  void scale(double max_ms) {
    const double step = max_ms > 25 ? 5 : max_ms > 8 ? 2 : 1;
    for (double ms = 0; ms <= max_ms; ms += step) {
      add("<line x1='%.1f' x2='%.1f' y1='36' y2='%d' stroke='#bbb' stroke-width='0.5'/>", x(ms), x(ms), y_);
      char number[16];
      std::snprintf(number, sizeof number, "%.0f", ms);
      text(x(ms) - 4, y_ + 16, number);
    }
    text(x(max_ms) - 60, y_ + 32, "ms after the exposure");
  }
  void text(double x, double y, const std::string& words) {
    add("<text x='%.1f' y='%.1f'>", x, y);
    body_ += words + "</text>\n";
  }
  std::string svg() const {
    return "<svg xmlns='http://www.w3.org/2000/svg' width='860' height='" + std::to_string(y_ + 44) +
           "' font-family='sans-serif' font-size='12'>\n<rect width='100%' height='100%' fill='white'/>\n" +
           body_ + "</svg>\n";
  }

 private:
  double x(double ms) const { return 230 + ms * ms_px_; }
  template <typename... Values>
  void add(const char* format, Values... values) {
    char line[256];
    std::snprintf(line, sizeof line, format, values...);
    body_ += line;
    body_ += '\n';
  }

  const double ms_px_;
  int y_ = 40;
  std::string body_;
};

std::string draw(const Life& life, const std::string& title) {
  const frame_t& f = life.summary;
  const std::int64_t exposed = f.utime + std::max(f.skew_us, 0);
  const auto ms = [](std::int64_t us) { return static_cast<double>(us) / 1e3; };
  const double started = ms(f.capture_to_start_us), sent = ms(f.latency_us);
  const double matched = sent - ms(f.publish_us), filtering = ms(f.filter_us);
  const double whole = std::max(ms(life.whole - exposed), sent);
  Drawing drawing(whole * 1.08);
  drawing.text(10, 22, title + ", frame " + std::to_string(f.frame));
  drawing.bar("received, paired", "#7f8c8d", 0, started);
  drawing.bar("rectified and matched, in bands", "#2980b9", started, matched - filtering);
  if (filtering > 0) drawing.bar("speckles removed", "#8e44ad", matched - filtering, matched);
  std::vector<std::pair<double, double>> blocks;
  for (std::size_t i = 0; i < life.came.size(); ++i) {
    blocks.emplace_back(ms(life.came[i] - exposed), static_cast<double>(life.first_row[i]) / f.height);
  }
  drawing.ticks("rows, when they came (top to bottom)", blocks);
  drawing.bar("from the last match to the last row sent", "#27ae60", matched, sent);
  drawing.bar("from then to the whole frame there", "#f39c12", sent, whole);
  drawing.scale(whole * 1.08);
  return drawing.svg();
}

int run(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: frame_life OUT.svg TITLE [PREFIX [FRAMES]]\n");
    return 1;
  }
  const int frames = argc > 4 ? std::max(std::atoi(argv[4]), 1) : 90;
  const Life life = median_of(listen(argc > 3 ? argv[3] : "STEREO", static_cast<std::size_t>(frames)));
  std::ofstream file(argv[1]);
  file << draw(life, argv[2]);
  if (!file.flush()) throw std::runtime_error(std::string(argv[1]) + " cannot be written");
  const frame_t& f = life.summary;
  std::printf("%s: start %.2f, rectify %.2f, match %.2f, filter %.2f, publish %.2f, sent %.2f ms\n", argv[2],
              f.capture_to_start_us / 1e3, f.rectify_us / 1e3, f.match_us / 1e3, f.filter_us / 1e3,
              f.publish_us / 1e3, f.latency_us / 1e3);
  return 0;
}

}  // namespace
}  // namespace stereod

int main(int argc, char** argv) {
  try {
    return stereod::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "frame_life: %s\n", error.what());
    return 1;
  }
}
