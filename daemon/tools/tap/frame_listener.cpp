// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/tap/frame_listener.h"

#include "daemon/lcm/message_decoder.h"

namespace stereod::tools {
namespace {

template <typename Message>
void listen(LcmReceiver& receiver, const std::string& channel, FrameAssembler& assembler) {
  // The message is a member of the lambda to reuse its memory.
  receiver.subscribe(channel, [&assembler, message = Message()](std::span<const std::byte> bytes) mutable {
    if (!decode_message(bytes, message)) return assembler.count_ignored();
    assembler.take(message);
  });
}

}  // namespace

void listen_for_frames(LcmReceiver& receiver, const TapOptions& tap, FrameAssembler& assembler) {
  listen<disparity_rows_t>(receiver, tap.channel("DISPARITY"), assembler);
  listen<frame_t>(receiver, tap.channel("FRAME"), assembler);
}

}  // namespace stereod::tools
