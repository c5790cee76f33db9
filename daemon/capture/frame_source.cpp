// SPDX-License-Identifier: BSD-3-Clause
// Names of source states, and the report of sources that have nothing more to say than their state.
#include "daemon/capture/frame_source.h"

#include "core/base/enum_names.h"

namespace stereod {
namespace {

constexpr EnumNames<SourceState, 7> kSourceStates{{{SourceState::kWaiting, "waiting"},
                                                   {SourceState::kAbsent, "absent"},
                                                   {SourceState::kOpening, "opening"},
                                                   {SourceState::kStreaming, "streaming"},
                                                   {SourceState::kStalled, "stalled"},
                                                   {SourceState::kLost, "lost"},
                                                   {SourceState::kFinished, "finished"}}};

}  // namespace

std::string_view name_of(SourceState state) { return find_name(kSourceStates, state); }

SourceReport FrameSource::report() const {
  SourceReport report;
  report.state = state();
  if (report.state == SourceState::kFinished) report.reason = "the recording has been played to its end";
  return report;
}

}  // namespace stereod
