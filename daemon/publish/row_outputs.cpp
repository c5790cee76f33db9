// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/publish/row_outputs.h"

#include "daemon/publish/cloud_publisher.h"
#include "daemon/publish/depth_publisher.h"
#include "daemon/publish/scan_publisher.h"
#include "daemon/publish/wire_format.h"

namespace stereod {

OwnedRowConsumers make_row_consumers(MessageBus& bus, const Config& config,
                                     const std::optional<Calibration>& calibration,
                                     const PublishedPixels& pixels) {
  OwnedRowConsumers consumers;
  if (!calibration) return consumers;
  const std::string& prefix = config.lcm.prefix;
  if (config.publish.depth) {
    consumers.push_back(
        std::make_unique<DepthPublisher>(bus, prefix, *calibration, config.matcher, pixels,
                                         wire_format(config, pixels.size()).rows_per_message));
  }
  if (config.scan.enabled) {
    consumers.push_back(std::make_unique<ScanPublisher>(bus, prefix, config.scan,
                                                        scan_geometry(*calibration, config.matcher)));
  }
  if (config.publish.cloud) {
    consumers.push_back(std::make_unique<CloudPublisher>(bus, prefix, *calibration, config.matcher, pixels,
                                                         config.publish.cloud_decimation));
  }
  return consumers;
}

RowConsumers references_to(const OwnedRowConsumers& owned) {
  RowConsumers consumers;
  for (const auto& consumer : owned) consumers.emplace_back(*consumer);
  return consumers;
}

}  // namespace stereod
