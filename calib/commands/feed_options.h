// SPDX-License-Identifier: BSD-3-Clause
// Command-line options for the source of live images.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "calib/live/frame_feed.h"

namespace stereod::calib {

struct FeedFlags {
  std::filesystem::path config;  ///< stereod.yaml whose cameras to open; empty: none
  bool daemon = false;           ///< receive the running daemon's images
  std::string lcm_url, prefix = "STEREO";

  /// Returns whether a live source is given.
  bool any() const { return daemon || !config.empty(); }
  /// Returns the message to show while no image arrives.
  std::string waiting_message() const;
};

void add_feed_options(CLI::App& command, FeedFlags& flags);

/// Opens the feed that @p flags name.
/// @throws UsageError unless exactly one of --config and --daemon is given; and as the constructors of the feeds do.
std::unique_ptr<FrameFeed> open_feed(const FeedFlags& flags);

}  // namespace stereod::calib
