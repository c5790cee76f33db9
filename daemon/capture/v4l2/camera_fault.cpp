// SPDX-License-Identifier: BSD-3-Clause
// Names of stages and reasons, and the sentences of failed calls.
#include "daemon/capture/v4l2/camera_fault.h"

#include <cerrno>
#include <cstring>

#include "core/base/enum_names.h"

namespace stereod::v4l2 {

namespace {

constexpr EnumNames<SetupStage, 15> kSetupStages{
    {{SetupStage::kFind, "finding the camera"},
     {SetupStage::kOpen, "opening the device"},
     {SetupStage::kCapability, "querying the device's capabilities"},
     {SetupStage::kListFormats, "listing the formats"},
     {SetupStage::kListSizes, "listing the sizes"},
     {SetupStage::kSetFormat, "setting the format"},
     {SetupStage::kSetRate, "setting the rate"},
     {SetupStage::kRequestBuffers, "requesting buffers"},
     {SetupStage::kMapBuffer, "mapping a buffer"},
     {SetupStage::kQueue, "queueing a buffer"},
     {SetupStage::kStart, "starting the stream"},
     {SetupStage::kWait, "waiting for a frame"},
     {SetupStage::kDequeue, "dequeueing a frame"},
     {SetupStage::kGiveBack, "giving a buffer back"},
     {SetupStage::kStop, "stopping the stream"}}};

constexpr EnumNames<CameraReason, 16> kReasons{{{CameraReason::kNone, "none"},
                                                {CameraReason::kNotFound, "not found"},
                                                {CameraReason::kAmbiguous, "ambiguous"},
                                                {CameraReason::kSameCamera, "same camera"},
                                                {CameraReason::kNoCamera, "no camera"},
                                                {CameraReason::kNotPermitted, "not permitted"},
                                                {CameraReason::kBusy, "busy"},
                                                {CameraReason::kNoFormat, "no format"},
                                                {CameraReason::kOtherFormat, "other format"},
                                                {CameraReason::kNoMemory, "no memory"},
                                                {CameraReason::kNoBandwidth, "no bandwidth"},
                                                {CameraReason::kMoreBandwidth, "more bandwidth"},
                                                {CameraReason::kUnplugged, "unplugged"},
                                                {CameraReason::kDriverError, "driver error"},
                                                {CameraReason::kSilent, "silent"},
                                                {CameraReason::kOnlyDamaged, "only damaged frames"}}};

}  // namespace

std::string_view name_of(SetupStage stage) { return find_name(kSetupStages, stage); }

std::string_view name_of(CameraReason reason) { return find_name(kReasons, reason); }

CameraReason reason_of(SetupStage stage, int error) {
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
    case ENOSPC:  // from usb_set_interface() and others, when the bus is full
      return stage >= SetupStage::kSetFormat ? CameraReason::kNoBandwidth : CameraReason::kDriverError;
    case ENOTTY:
      return stage == SetupStage::kCapability ? CameraReason::kNoCamera : CameraReason::kDriverError;
    case EINVAL:
      if (stage == SetupStage::kCapability) return CameraReason::kNoCamera;
      return stage == SetupStage::kSetFormat ? CameraReason::kNoFormat : CameraReason::kDriverError;
    default:
      return CameraReason::kDriverError;
  }
}

CameraFault fault_of(SetupStage stage, int error, const std::string& device) {
  CameraFault fault{reason_of(stage, error), stage, error, ""};
  const std::string where = device + ": " + std::string(name_of(stage)) + ": ";
  switch (fault.reason) {
    case CameraReason::kUnplugged:
      fault.sentence = device + " was unplugged; plug it in again";
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
      fault.sentence = device + " is not a camera; 'stereod --list-cameras' lists the cameras";
      break;
    default:
      fault.sentence = where + std::strerror(error);
  }
  return fault;
}

}  // namespace stereod::v4l2
