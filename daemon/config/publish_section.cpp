// SPDX-License-Identifier: BSD-3-Clause
// Reads the section `publish`.
#include <utility>

#include "core/base/limits.h"
#include "daemon/config/sections.h"

namespace stereod {
namespace {

constexpr int kMaxDecimation = 64;

}  // namespace

const Options<PublishConfig>& region_options() {
  using P = PublishConfig;
  static const Options<P> table{
      option<&P::left>({.key = "left",
                        .unit = "px",
                        .minimum = 0,
                        .maximum = kMaxImageSide,
                        .description = "First column of the rectified image."}),
      option<&P::top>({.key = "top",
                       .unit = "px",
                       .minimum = 0,
                       .maximum = kMaxImageSide,
                       .description = "First row of the rectified image."}),
      option<&P::width>({.key = "width",
                         .unit = "px",
                         .minimum = 0,
                         .maximum = kMaxImageSide,
                         .default_name = "up to the edge",
                         .description = "Number of columns."}),
      option<&P::height>({.key = "height",
                          .unit = "px",
                          .minimum = 0,
                          .maximum = kMaxImageSide,
                          .default_name = "up to the edge",
                          .description = "Number of rows."}),
  };
  return table;
}

const Options<PublishConfig>& publish_options() {
  using P = PublishConfig;
  static const Options<P> table{
      option<&P::decimation_x>(
          {.key = "decimation_x",
           .minimum = 1,
           .maximum = kMaxDecimation,
           .description = "n: stereod sends every n-th column. Saves network load, not computing time."}),
      option<&P::decimation_y>({.key = "decimation_y",
                                .minimum = 1,
                                .maximum = kMaxDecimation,
                                .description = "n: stereod sends every n-th row."}),
      option<&P::depth>({.key = "depth",
                         .description =
                             "Also publishes depth in millimeters as STEREO_DEPTH (depth_rows_t), 16 bits a "
                             "pixel. Needs a calibration."}),
      option<&P::cloud>({.key = "cloud",
                         .description =
                             "Also publishes points in meters as STEREO_CLOUD (bot_core.pointcloud_t), one "
                             "message a frame. Needs a calibration."}),
      option<&P::cloud_decimation>(
          {.key = "cloud_decimation",
           .minimum = 1,
           .maximum = kMaxDecimation,
           .description =
               "n: the point cloud contains every n-th column and every n-th row of the region. With 8, the points "
               "of 640×480 pixels fit into one datagram; losing one of several datagrams loses all points."}),
  };
  return table;
}

void read_publish_section(YamlSection section, PublishConfig& publish) {
  YamlSection region = section.section("region");
  region.read(region_options(), publish);
  region.finish();
  section.read(publish_options(), publish);
  section.finish();
}

}  // namespace stereod
