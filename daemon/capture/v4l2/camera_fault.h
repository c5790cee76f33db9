// SPDX-License-Identifier: BSD-3-Clause
// Why a camera does not stream: typed reasons, and sentences for people.
#pragma once

#include <string>
#include <string_view>

namespace stereod::v4l2 {

/// What is done with a camera, in this order.
enum class SetupStage {
  kFind,
  kOpen,
  kCapability,
  kListFormats,
  kListSizes,
  kSetFormat,
  kSetRate,
  kRequestBuffers,
  kMapBuffer,
  kQueue,
  kStart,
  kWait,
  kDequeue,
  kGiveBack,
  kStop,
};
/// Returns a phrase for people: "setting the format".
std::string_view name_of(SetupStage stage);

/// Why a camera does not stream.
enum class CameraReason {
  kNone,
  kNotFound,       ///< no device of that name
  kAmbiguous,      ///< `auto` without two cameras
  kSameCamera,     ///< left and right are one device
  kNoCamera,       ///< the device captures no images
  kNotPermitted,   ///< the user may not open the device
  kBusy,           ///< another program uses the camera
  kNoFormat,       ///< the size or the format is not offered
  kOtherFormat,    ///< the driver chose another format than the requested one
  kNoMemory,       ///< out of memory
  kNoBandwidth,    ///< the bus cannot carry the stream
  kMoreBandwidth,  ///< the bus may carry more than before
  kUnplugged,      ///< the device was removed
  kDriverError,    ///< any other error
  kSilent,         ///< set up, but delivers no frames
  kOnlyDamaged,    ///< delivers frames, all of them damaged
};
/// Returns a phrase for people: "no bandwidth".
std::string_view name_of(CameraReason reason);

/// One failure.
struct CameraFault {
  CameraReason reason = CameraReason::kNone;
  SetupStage stage = SetupStage::kFind;
  int error = 0;         ///< errno value; 0 if no call failed
  std::string sentence;  ///< what happened, and what to do
};

/// Classifies an errno value of a stage.
CameraReason reason_of(SetupStage stage, int error);

/// Returns the fault of a failed call, with a sentence that names @p device.
CameraFault fault_of(SetupStage stage, int error, const std::string& device);

}  // namespace stereod::v4l2
