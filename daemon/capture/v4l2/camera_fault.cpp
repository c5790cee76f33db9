#include "daemon/capture/v4l2/camera_fault.h"

#include <cerrno>
#include <cstring>

namespace stereod {

std::string_view name_of(CameraState state) {
  switch (state) {
    case CameraState::kAbsent:
      return "absent";
    case CameraState::kOpening:
      return "opening";
    case CameraState::kStreaming:
      return "streaming";
    case CameraState::kWedged:
      return "wedged";
    case CameraState::kLost:
      return "lost";
  }
  return "?";
}

std::string_view name_of(CameraStep step) {
  switch (step) {
    case CameraStep::kFind:
      return "finding it";
    case CameraStep::kOpen:
      return "opening it";
    case CameraStep::kCapability:
      return "asking what it is";
    case CameraStep::kListFormats:
      return "listing its formats";
    case CameraStep::kListSizes:
      return "listing its sizes";
    case CameraStep::kSetFormat:
      return "setting the format";
    case CameraStep::kSetRate:
      return "setting the rate";
    case CameraStep::kRequestBuffers:
      return "asking for buffers";
    case CameraStep::kMapBuffer:
      return "mapping a buffer";
    case CameraStep::kQueue:
      return "queueing a buffer";
    case CameraStep::kStart:
      return "starting the stream";
    case CameraStep::kWait:
      return "waiting for a frame";
    case CameraStep::kDequeue:
      return "fetching a frame";
    case CameraStep::kGiveBack:
      return "giving a buffer back";
    case CameraStep::kStop:
      return "stopping the stream";
  }
  return "?";
}

std::string_view name_of(CameraReason reason) {
  switch (reason) {
    case CameraReason::kNone:
      return "none";
    case CameraReason::kNotFound:
      return "not found";
    case CameraReason::kAmbiguous:
      return "ambiguous";
    case CameraReason::kSameCamera:
      return "same camera";
    case CameraReason::kNoCamera:
      return "no camera";
    case CameraReason::kNotPermitted:
      return "not permitted";
    case CameraReason::kBusy:
      return "busy";
    case CameraReason::kNoFormat:
      return "no format";
    case CameraReason::kOtherFormat:
      return "other format";
    case CameraReason::kNoMemory:
      return "no memory";
    case CameraReason::kNoBandwidth:
      return "no bandwidth";
    case CameraReason::kMoreBandwidth:
      return "more bandwidth";
    case CameraReason::kUnplugged:
      return "unplugged";
    case CameraReason::kDriverError:
      return "driver error";
    case CameraReason::kSilent:
      return "silent";
    case CameraReason::kOnlyDamaged:
      return "only damaged frames";
  }
  return "?";
}

CameraReason reason_of(CameraStep step, int error) {
  switch (error) {
    case ENODEV:
    case ENXIO:
    case ENOENT:
      return CameraReason::kUnplugged;
    case EACCES:
    case EPERM:
      return CameraReason::kNotPermitted;
    case EBUSY:
      return CameraReason::kBusy;
    case ENOMEM:
      return CameraReason::kNoMemory;
    case ENOSPC:  // usb_set_interface() and its kin, when the bus has no room left
      return step >= CameraStep::kSetFormat ? CameraReason::kNoBandwidth : CameraReason::kDriverError;
    case ENOTTY:
      return step == CameraStep::kCapability ? CameraReason::kNoCamera : CameraReason::kDriverError;
    case EINVAL:
      if (step == CameraStep::kCapability) return CameraReason::kNoCamera;
      return step == CameraStep::kSetFormat ? CameraReason::kNoFormat : CameraReason::kDriverError;
    default:
      return CameraReason::kDriverError;
  }
}

CameraFault fault_of(CameraStep step, int error, const std::string& device) {
  CameraFault fault{reason_of(step, error), step, error, ""};
  const std::string where = device + ": " + std::string(name_of(step)) + ": ";
  switch (fault.reason) {
    case CameraReason::kUnplugged:
      fault.sentence = device + " was unplugged; it is used again as soon as it is back";
      break;
    case CameraReason::kNotPermitted:
      fault.sentence = where + "not permitted; add this user to the group that owns the device (video)";
      break;
    case CameraReason::kBusy:
      fault.sentence = where + "another program uses the camera; end that program";
      break;
    case CameraReason::kNoMemory:
      fault.sentence = where + "the kernel has no memory for buffers";
      break;
    case CameraReason::kNoCamera:
      fault.sentence = device + " is no camera; 'stereod --list-cameras' shows those there are";
      break;
    default:
      fault.sentence = where + std::strerror(error);  // NOLINT(concurrency-mt-unsafe)
  }
  return fault;
}

}  // namespace stereod
