// stereo-tap record and play: LCM logs.
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

namespace stereod {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// Between two messages; more is a pause that nobody needs, or a damaged time.
constexpr double kMaxWait_s = 10;

void print(const LogSummary& summary) {
  for (const std::string& line : summary.lines()) std::printf("%s\n", line.c_str());
}

/// Sleeps until then, or until a signal comes; false if one did.
bool sleep_until(Clock::time_point due, StopSignals& stop) {
  while (!stop.arrived()) {
    const Clock::time_point now = Clock::now();
    if (now >= due) return true;
    std::this_thread::sleep_until(std::min(due, now + milliseconds(50)));
  }
  return false;
}

void complain_of_damage(const PlayOptions& options, const LcmLogReader& reader) {
  if (reader.damaged_places() == 0) return;
  complain(options.file.string() + ": " + std::to_string(reader.damaged_places()) +
           " places of the log were damaged and passed over (a log that was cut off ends with one).");
}

int list_log(const PlayOptions& options) {
  LcmLogReader reader(options.file);
  LogSummary summary;
  for (LogEvent event; reader.next(event);) summary.add(event.channel, event.utime, event.data.size());
  print(summary);
  complain_of_damage(options, reader);
  return summary.messages() > 0 ? kAllWell : kNothingArrived;
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
  if (summary.messages() > 0) return kAllWell;
  complain("nothing on " + tap.channel("*") + " (" + receiver.url() + "); is stereod running?");
  return kNothingArrived;
}

int run_play(const TapOptions& tap, const PlayOptions& options, StopSignals& stop) {
  if (options.list_only) return list_log(options);
  LcmLogReader reader(options.file);
  LcmBus bus(tap.lcm_url);
  LogSummary summary;
  std::int64_t refused = 0, jumps = 0;
  double after_s = 0, previous_s = 0;
  const Clock::time_point begin = Clock::now();
  for (LogEvent event; reader.next(event);) {
    const double event_s = static_cast<double>(event.utime) * 1e-6;
    const double step_s = summary.messages() == 0 ? 0 : event_s - previous_s;
    previous_s = event_s;
    if (std::abs(step_s) > kMaxWait_s) {
      ++jumps;
    } else {
      after_s += step_s / options.speed;
    }
    if (!sleep_until(
            begin + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(after_s)),
            stop)) {
      break;
    }
    if (!bus.publish(event.channel.c_str(), event.data.data(), event.data.size())) ++refused;
    summary.add(event.channel, event.utime, event.data.size());
  }
  print(summary);
  complain_of_damage(options, reader);
  if (jumps > 0) {
    complain("the times of " + std::to_string(jumps) +
             " messages were more than ten seconds before or after those of the last one; they were not "
             "waited for.");
  }
  if (refused > 0) complain(std::to_string(refused) + " messages were refused by the network.");
  return refused > 0 ? kSomethingLost : summary.messages() > 0 ? kAllWell : kNothingArrived;
}

}  // namespace stereod
