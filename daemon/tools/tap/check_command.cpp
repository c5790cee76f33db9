// SPDX-License-Identifier: BSD-3-Clause
// stereo-tap check: counts what arrives and measures latency.
#include <chrono>
#include <cstdint>
#include <cstdio>

#include "daemon/base/stop_signals.h"
#include "daemon/client/stereod_client.h"
#include "daemon/lcm/receiver.h"
#include "daemon/tools/tap/frame_listener.h"
#include "daemon/tools/tap/reception_report.h"
#include "daemon/tools/tap/tap.h"
#include "daemon/tools/tap/text_table.h"

namespace stereod::tools {
namespace {

using Clock = std::chrono::steady_clock;

/// Returns the time [µs since the Unix epoch].
std::int64_t now_utime() {
  using std::chrono::microseconds;
  return std::chrono::duration_cast<microseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

Reception receive_for(const TapOptions& tap, double seconds, LcmReceiver& receiver, StopSignals& stop) {
  Reception reception;
  FrameAssembler assembler([&reception](StereoFrame&& frame) {
    if (!frame.complete()) return;
    reception.arrival_ms.push_back(static_cast<double>(now_utime() - frame.utime) / 1e3);
    reception.latency_ms.push_back(static_cast<double>(frame.summary->latency_us) / 1e3);
    if (reception.frames++ == 0) reception.first_utime = frame.utime;
    reception.last_utime = frame.utime;
  });
  listen_for_frames(receiver, tap, assembler);
  const Clock::time_point end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  while (Clock::now() < end && !stop.arrived()) receiver.receive(std::chrono::milliseconds(50));
  assembler.finish();
  reception.counts = assembler.counts();
  return reception;
}

}  // namespace

int run_check(const TapOptions& tap, const CheckOptions& options, StopSignals& stop) {
  LcmReceiver receiver(tap.lcm_url);
  const Reception reception = receive_for(tap, options.seconds, receiver, stop);
  if (!reception.anything_arrived()) {
    print_error("no complete frame on " + tap.channel("DISPARITY") + " and " + tap.channel("FRAME") +
                " within " + fixed(options.seconds, 1) + " s (" + receiver.url() +
                "); is stereod streaming?");
    return kNothingArrived;
  }
  for (const std::string& line : report_lines(reception)) std::printf("%s\n", line.c_str());
  if (!reception.anything_lost()) return kSuccess;
  if (reception.counts.messages_of_another > 0) return kSomethingLost;  // the report says what to do
  if (const auto advice = receive_buffer_advice(kernel_receive_buffer_limit())) print_error(*advice);
  return kSomethingLost;
}

}  // namespace stereod::tools
