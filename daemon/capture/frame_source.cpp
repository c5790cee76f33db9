#include "daemon/capture/frame_source.h"

namespace stereod {

SourceReport FrameSource::report() const {
  SourceReport report;
  switch (state()) {
    case SourceState::kWaiting:
      report.state = "waiting";
      break;
    case SourceState::kStreaming:
      report.state = "streaming";
      break;
    case SourceState::kFinished:
      report.state = "finished";
      report.reason = "the recording has played to its end";
  }
  return report;
}

}  // namespace stereod
