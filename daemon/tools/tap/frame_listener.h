// From LCM's messages to the frame assembler.
#pragma once

#include "daemon/client/stereod_client.h"
#include "daemon/lcm/receiver.h"
#include "daemon/tools/tap/tap.h"

namespace stereod {

/// Subscribes to disparity rows and frames and feeds them to `assembler`, which lives as long as `receiver`
/// receives. Throws BusError.
void listen_for_frames(LcmReceiver& receiver, const TapOptions& tap, FrameAssembler& assembler);

}  // namespace stereod
