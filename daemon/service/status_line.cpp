#include "daemon/service/status_line.h"

#include <cstdio>

namespace stereod {
namespace {

std::string state_in_words(const std::string& state) {
  if (state == "waiting_for_cameras") return "Waiting for cameras";
  if (state.empty()) return "Unknown";
  std::string words = state;
  if (words[0] >= 'a' && words[0] <= 'z') words[0] = static_cast<char>(words[0] - 'a' + 'A');
  return words;
}

}  // namespace

std::string status_line(const status_t& status) {
  std::string line = state_in_words(status.state);
  if (status.fps_out > 0) {
    char stats[100];
    std::snprintf(stats, sizeof stats, ": %.1f frames a second, %.0f ms from exposure to the last row",
                  status.fps_out, status.latency_ms_median);
    line += stats;
  }
  if (!status.reason.empty()) line += (status.fps_out > 0 ? "; " : ": ") + status.reason;
  return line + ".";
}

}  // namespace stereod
