#include "daemon/config/publish_section.h"

#include <utility>

namespace stereod {
namespace {

constexpr int kMaxSide = 4096;
constexpr int kMaxStep = 64;

void read_region(YamlSection section, PublishConfig& publish) {
  publish.left = section.integer("left", publish.left, 0, kMaxSide);
  publish.top = section.integer("top", publish.top, 0, kMaxSide);
  publish.width = section.integer("width", publish.width, 0, kMaxSide);
  publish.height = section.integer("height", publish.height, 0, kMaxSide);
  section.finish();
}

}  // namespace

void read_publish_section(YamlSection section, PublishConfig& publish) {
  read_region(section.section("region"), publish);
  publish.decimation_x = section.integer("decimation_x", publish.decimation_x, 1, kMaxStep);
  publish.decimation_y = section.integer("decimation_y", publish.decimation_y, 1, kMaxStep);
  publish.depth = section.flag("depth", publish.depth);
  publish.cloud = section.flag("cloud", publish.cloud);
  publish.cloud_decimation = section.integer("cloud_decimation", publish.cloud_decimation, 1, kMaxStep);
  section.finish();
}

}  // namespace stereod
