// SPDX-License-Identifier: BSD-3-Clause
// The optional outputs that the configuration asks for.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/geometry/calibration.h"
#include "daemon/config/config.h"
#include "daemon/lcm/message_bus.h"
#include "daemon/publish/published_pixels.h"
#include "daemon/publish/row_consumer.h"

namespace stereod {

using OwnedRowConsumers = std::vector<std::unique_ptr<RowConsumer>>;

/// Creates the outputs that @p config enables. They need a calibration; without one the list is empty.
/// @p bus must outlive them.
OwnedRowConsumers make_row_consumers(MessageBus& bus, const Config& config,
                                     const std::optional<Calibration>& calibration,
                                     const PublishedPixels& pixels);

/// Returns references to the consumers in @p owned, in the same order.
RowConsumers references_to(const OwnedRowConsumers& owned);

}  // namespace stereod
