// Where live images come from, as a command line says it.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "calib/live/frame_feed.h"

namespace stereod {

struct FeedFlags {
  std::filesystem::path config;  ///< open the cameras of this stereod.yaml, or
  bool daemon = false;           ///< take the running daemon's images
  std::string lcm_url, prefix = "STEREO";

  bool any() const { return daemon || !config.empty(); }
  /// What to tell a person while nothing comes.
  std::string waiting_words() const;
};

void add_feed_options(CLI::App& command, FeedFlags& flags);

/// Throws UsageError unless exactly one of the two is asked for, and what the feeds' constructors throw.
std::unique_ptr<FrameFeed> open_feed(const FeedFlags& flags);

}  // namespace stereod
