#include "daemon/tools/tap/frame_listener.h"

#include "daemon/lcm/message_decoder.h"

namespace stereod {
namespace {

template <typename Message>
void listen(LcmReceiver& receiver, const std::string& channel, FrameAssembler& assembler) {
  // The message is kept from one call to the next so that its memory is used again.
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

}  // namespace stereod
