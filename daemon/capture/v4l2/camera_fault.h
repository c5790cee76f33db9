// Why a camera does not stream: typed reasons, and sentences for people.
#pragma once

#include <string>
#include <string_view>

namespace stereod {

/// Where a camera stands. It goes absent → opening → streaming; from streaming to wedged when it falls
/// silent, to lost when it is unplugged or its driver fails; and from both back to absent or opening, for
/// ever.
enum class CameraState {
  kAbsent,     ///< no such camera is plugged in
  kOpening,    ///< there, and being set up; no frame yet
  kStreaming,  ///< frames come
  kStalled,    ///< set up, but silent; it is set up anew again and again
  kLost,       ///< it streamed, and then went away or failed
};
std::string_view name_of(CameraState state);

/// What is done to a camera, in the order it is done.
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
std::string_view name_of(SetupStage step);

enum class CameraReason {
  kNone,
  kNotFound,       ///< no device of that name
  kAmbiguous,      ///< `auto` without two cameras
  kSameCamera,     ///< left and right are one device
  kNoCamera,       ///< the device gives no images
  kNotPermitted,   ///< this user may not open it
  kBusy,           ///< another program has it
  kNoFormat,       ///< size or format are not offered
  kOtherFormat,    ///< the driver made something else of the request
  kNoMemory,       ///< no buffers
  kNoBandwidth,    ///< the bus cannot carry it
  kMoreBandwidth,  ///< the bus may carry more than before
  kUnplugged,      ///< the device went away
  kDriverError,    ///< any other error
  kSilent,         ///< set up, but no frame comes
  kOnlyDamaged,    ///< frames come, but none is a image
};
std::string_view name_of(CameraReason reason);

/// One failure.
struct CameraFault {
  CameraReason reason = CameraReason::kNone;
  SetupStage step = SetupStage::kFind;
  int error = 0;         ///< errno; 0 if no call failed
  std::string sentence;  ///< what was found, and what to do
};

/// What an error of a step means.
CameraReason reason_of(SetupStage step, int error);

/// The fault of a call that failed; the sentence names the device.
CameraFault fault_of(SetupStage step, int error, const std::string& device);

}  // namespace stereod
