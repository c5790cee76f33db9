// SPDX-License-Identifier: BSD-3-Clause
// Lists the options of each section of stereod.yaml, and reads the sections. The options of `matcher` are in
// core/match/option_table.h.
#pragma once

#include <vector>

#include "core/base/option.h"
#include "daemon/config/config.h"
#include "daemon/config/yaml_section.h"

namespace stereod {

template <typename Settings>
using Options = std::vector<Option<Settings>>;

/// Return the tables of the sections, each in the order of the manual.
const Options<Config>& root_options();
const Options<CamerasConfig>& cameras_options();
const Options<V4l2Config>& v4l2_options();
const Options<CamerasConfig>& replay_options();
const Options<CamerasConfig>& log_source_options();
const Options<CamerasConfig>& synthetic_options();
const Options<RectifyConfig>& rectify_options();
const Options<SchedulingConfig>& scheduling_options();
const Options<LcmConfig>& lcm_options();
const Options<PublishConfig>& publish_options();
const Options<PublishConfig>& region_options();
const Options<ScanConfig>& scan_options();
const Options<Config>& log_options();

/// Read the sections that need more than their tables. @throws FileError.
void read_cameras_section(YamlSection section, CamerasConfig& cameras);
void read_v4l2_section(YamlSection& cameras_section, CamerasConfig& cameras);
void read_matcher_section(YamlSection section, MatcherOptions& options);
void read_publish_section(YamlSection section, PublishConfig& publish);
void read_scan_section(YamlSection section, ScanConfig& scan);

}  // namespace stereod
