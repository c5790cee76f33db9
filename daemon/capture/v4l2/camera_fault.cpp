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
    case CameraState::kStalled:
      return "wedged";
    case CameraState::kLost:
      return "lost";
  }
  return "?";
}

std::string_view name_of(SetupStage step) {
  switch (step) {
    case SetupStage::kFind:
      return "finding it";
    case SetupStage::kOpen:
      return "opening it";
    case SetupStage::kCapability:
      return "asking what it is";
    case SetupStage::kListFormats:
      return "listing its formats";
    case SetupStage::kListSizes:
      return "listing its sizes";
    case SetupStage::kSetFormat:
      return "setting the format";
    case SetupStage::kSetRate:
      return "setting the rate";
    case SetupStage::kRequestBuffers:
      return "asking for buffers";
    case SetupStage::kMapBuffer:
      return "mapping a buffer";
    case SetupStage::kQueue:
      return "queueing a buffer";
    case SetupStage::kStart:
      return "starting the stream";
    case SetupStage::kWait:
      return "waiting for a frame";
    case SetupStage::kDequeue:
      return "fetching a frame";
    case SetupStage::kGiveBack:
      return "giving a buffer back";
    case SetupStage::kStop:
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

CameraReason reason_of(SetupStage step, int error) {
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
      return step >= SetupStage::kSetFormat ? CameraReason::kNoBandwidth : CameraReason::kDriverError;
    case ENOTTY:
      return step == SetupStage::kCapability ? CameraReason::kNoCamera : CameraReason::kDriverError;
    case EINVAL:
      if (step == SetupStage::kCapability) return CameraReason::kNoCamera;
      return step == SetupStage::kSetFormat ? CameraReason::kNoFormat : CameraReason::kDriverError;
    default:
      return CameraReason::kDriverError;
  }
}

CameraFault fault_of(SetupStage step, int error, const std::string& device) {
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
