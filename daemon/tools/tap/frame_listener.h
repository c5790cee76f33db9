// SPDX-License-Identifier: BSD-3-Clause
// Feeds LCM messages to a frame assembler.
#pragma once

#include "daemon/client/stereod_client.h"
#include "daemon/lcm/receiver.h"
#include "daemon/tools/tap/tap.h"

namespace stereod::tools {

/// Subscribes to disparity rows and frame summaries and passes them to @p assembler, which must live as long as @p receiver
/// receives. Throws BusError.
void listen_for_frames(LcmReceiver& receiver, const TapOptions& tap, FrameAssembler& assembler);

}  // namespace stereod::tools
