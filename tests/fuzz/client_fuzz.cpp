// SPDX-License-Identifier: BSD-3-Clause
// Passes any bytes as messages to the three channels of the client library: a byte for the channel, two bytes for the length,
// then the message. Reads every pixel of what is handed over. A fuzzer with clang and -fsanitize=fuzzer; otherwise
// client_by_mutation.cpp drives it as a test.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "daemon/client/stereod_client.h"
#include "tests/fuzz/client_fuzz.h"

namespace stereod {

int frames_of_last_input = 0;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void read(const StereoFrame& frame) {
  const int width = frame.disparity.width(), height = frame.disparity.height();
  require(static_cast<int>(frame.row_present.size()) == height && frame.rows_received <= frame.rows_expected);
  require(frame.depths_m().size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const auto points = frame.points(), all = frame.points(1, Pixels::kMeasuredOrFilled);
  require(points.size() <= all.size());
  if (frame.confidence.width() > 0)
    require(frame.confidence.width() == width && frame.confidence.height() == height);
  for (const StereoPoint& point : all) require(std::isfinite(point.z));
  require(frame.grid.image_x(width - 1) < 4096 && frame.grid.image_y(height - 1) < 4096);
}

void read(const RowBlock& block) {
  const disparity_rows_t& m = block.message();
  std::vector<std::int16_t> row(static_cast<std::size_t>(m.width));
  int sum = 0;
  for (int y = m.first_row; y < m.first_row + m.row_count; ++y) {
    block.copy_row(y, row.data());
    if (block.has_confidence())
      sum = std::accumulate(block.confidence_row(y), block.confidence_row(y) + m.width, sum);
    for (const std::int16_t value : row) require(value >= DisparityMap::kNone);
    block.copy_row(y, row.data(), Pixels::kMeasuredOrFilled);
    for (const std::int16_t value : row) require(value >= DisparityMap::kNone);
  }
  require(sum >= 0);
}

void run(const std::uint8_t* data, std::size_t size) {
  const auto client = StereoClient::unconnected();
  frames_of_last_input = 0;
  client->on_frame([](StereoFrame&& frame) {
    read(frame);
    ++frames_of_last_input;
  });
  client->on_rows([](const RowBlock& block) { read(block); });
  while (size >= 3) {
    const int channel = data[0] % 3;
    const std::size_t length = std::min(size - 3, std::size_t{data[1]} + 256 * std::size_t{data[2]});
    // A separate copy, so that a sanitizer notices a read past its end.
    const std::vector<std::uint8_t> message(data + 3, data + 3 + length);
    if (channel == 0) client->take_rows(message.data(), message.size());
    if (channel == 1) client->take_frame(message.data(), message.size());
    if (channel == 2) client->take_camera_info(message.data(), message.size());
    data += 3 + length;
    size -= 3 + length;
  }
  describe_problems(client->counts());
}

}  // namespace
}  // namespace stereod

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  stereod::run(data, size);
  return 0;
}
