// SPDX-License-Identifier: BSD-3-Clause
// stereo-tap record and play: write and publish LCM logs.
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <thread>

#include "daemon/base/stop_signals.h"
#include "daemon/lcm/bus.h"
#include "daemon/lcm/log.h"
#include "daemon/lcm/receiver.h"
#include "daemon/tools/tap/log_summary.h"
#include "daemon/tools/tap/tap.h"
#include "daemon/tools/tap/text_table.h"

namespace stereod::tools {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// Longest wait for the next message; a longer one is a pause in the recording or a damaged time.
constexpr double kMaxWait_s = 10;

void print(const LogSummary& summary) {
  for (const std::string& line : summary.lines()) std::printf("%s\n", line.c_str());
}

/// Sleeps until @p due. Returns false if a signal arrived first.
bool sleep_until(Clock::time_point due, StopSignals& stop) {
  while (!stop.arrived()) {
    const Clock::time_point now = Clock::now();
    if (now >= due) return true;
    std::this_thread::sleep_until(std::min(due, now + milliseconds(50)));
  }
  return false;
}

void report_damage(const PlayOptions& options, const LcmLogReader& reader) {
  if (reader.damaged_places() == 0) return;
  print_error(options.file.string() + ": " + std::to_string(reader.damaged_places()) +
              " damaged places skipped (a truncated log ends with one)");
}

int list_log(const PlayOptions& options) {
  LcmLogReader reader(options.file);
  LogSummary summary;
  for (LogEvent event; reader.next(event);) summary.add(event.channel, event.utime, event.data.size());
  print(summary);
  report_damage(options, reader);
  return summary.messages() > 0 ? kSuccess : kNothingArrived;
}

}  // namespace

int run_record(const TapOptions& tap, const RecordOptions& options, StopSignals& stop) {
  LcmReceiver receiver(tap.lcm_url);
  LcmLogWriter writer(options.file);
  LogSummary summary;
  receiver.subscribe_all(tap.prefix,
                         [&](std::string_view channel, std::int64_t utime, std::span<const std::byte> data) {
                           writer.write(utime, channel, data);
                           summary.add(channel, utime, data.size());
                         });
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(
                                      options.seconds > 0 ? options.seconds : 1e8));
  while (Clock::now() < end && !stop.arrived()) receiver.receive(milliseconds(50));
  writer.finish();
  print(summary);
  if (summary.messages() > 0) return kSuccess;
  print_error("no message on " + tap.channel("*") + " (" + receiver.url() + "); is stereod running?");
  return kNothingArrived;
}

int run_play(const TapOptions& tap, const PlayOptions& options, StopSignals& stop) {
  if (options.list_only) return list_log(options);
  LcmLogReader reader(options.file);
  LcmBus bus(tap.lcm_url);
  LogSummary summary;
  std::int64_t refused = 0, jumps = 0;
  double due_s = 0, previous_s = 0;
  const Clock::time_point begin = Clock::now();
  for (LogEvent event; reader.next(event);) {
    const double event_s = static_cast<double>(event.utime) * 1e-6;
    const double step_s = summary.messages() == 0 ? 0 : event_s - previous_s;
    previous_s = event_s;
    if (std::abs(step_s) > kMaxWait_s) {
      ++jumps;
    } else {
      due_s += step_s / options.speed;
    }
    if (!sleep_until(
            begin + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(due_s)),
            stop)) {
      break;
    }
    if (!bus.publish(event.channel.c_str(), event.data.data(), event.data.size())) ++refused;
    summary.add(event.channel, event.utime, event.data.size());
  }
  print(summary);
  report_damage(options, reader);
  if (jumps > 0) {
    print_error(std::to_string(jumps) + " messages are more than " + fixed(kMaxWait_s, 0) +
                " s before or after their predecessor; published without waiting");
  }
  if (refused > 0) print_error(std::to_string(refused) + " messages could not be sent");
  return refused > 0 ? kSomethingLost : summary.messages() > 0 ? kSuccess : kNothingArrived;
}

}  // namespace stereod::tools
