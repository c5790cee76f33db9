// SPDX-License-Identifier: BSD-3-Clause
#include "core/rectify/run_table.h"

#include <algorithm>
#include <utility>

namespace stereod {

RunTable::RunTable(int width, std::vector<int> ends, std::ptrdiff_t pixel_stride, std::ptrdiff_t reach,
                   std::ptrdiff_t source_bytes)
    : width_(width),
      ends_(std::move(ends)),
      pixel_stride_(pixel_stride),
      reach_(reach),
      source_bytes_(source_bytes) {}

void RunTable::append(const std::int32_t* offsets) {
  const std::size_t begin = runs_.size();
  bool holes = false, reaches_beyond = reach_ == 0;
  auto end = ends_.begin();
  for (int x = 0; x < width_;) {
    if (x == *end) ++end;
    const std::int32_t source = offsets[x];
    const std::ptrdiff_t step = source < 0 ? 0 : pixel_stride_;
    const int max_count = std::min(kRunPixels, *end - x);
    int count = 1;
    while (count < max_count && offsets[x + count] == source + count * step) ++count;
    holes = holes || source < 0;
    reaches_beyond = reaches_beyond || source + reach_ > source_bytes_;
    runs_.push_back({source, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(count)});
    x += count;
  }
  const Kind kind = reaches_beyond ? Kind::kExactRuns : holes ? Kind::kWholeRunsOrNone : Kind::kWholeRuns;
  if (2 * (runs_.size() - begin) > static_cast<std::size_t>(width_)) {
    runs_.resize(begin);
    rows_.push_back({static_cast<std::uint32_t>(offsets_.size()), Kind::kOffsets});
    offsets_.insert(offsets_.end(), offsets, offsets + width_);
    return;
  }
  runs_.push_back({-1, static_cast<std::uint16_t>(width_), 0});
  rows_.push_back({static_cast<std::uint32_t>(begin), kind});
}

std::int32_t RunTable::offset(int x, int y) const {
  const Row& entry = row(y);
  if (entry.kind == Kind::kOffsets) return offsets(entry)[x];
  const Run* run = runs(entry);
  while (run[1].first <= x) ++run;
  if (run->source < 0) return run->source;
  return run->source + static_cast<std::int32_t>((x - run->first) * pixel_stride_);
}

std::size_t RunTable::bytes() const {
  return rows_.size() * sizeof(Row) + runs_.size() * sizeof(Run) + offsets_.size() * sizeof(std::int32_t);
}

}  // namespace stereod
