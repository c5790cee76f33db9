#include "daemon/config/publish_section.h"

#include <utility>

namespace stereod {
namespace {

constexpr int kMostSide = 4096;
constexpr int kMostStep = 64;

void read_region(YamlSection section, PublishConfig& publish) {
  publish.left = section.integer("left", publish.left, 0, kMostSide);
  publish.top = section.integer("top", publish.top, 0, kMostSide);
  publish.width = section.integer("width", publish.width, 0, kMostSide);
  publish.height = section.integer("height", publish.height, 0, kMostSide);
  section.finish();
}

}  // namespace

void read_publish_section(YamlSection section, PublishConfig& publish) {
  read_region(section.section("region"), publish);
  publish.column_step = section.integer("column_step", publish.column_step, 1, kMostStep);
  publish.row_step = section.integer("row_step", publish.row_step, 1, kMostStep);
  publish.depth = section.flag("depth", publish.depth);
  publish.cloud = section.flag("cloud", publish.cloud);
  publish.cloud_step = section.integer("cloud_step", publish.cloud_step, 1, kMostStep);
  section.finish();
}

}  // namespace stereod
