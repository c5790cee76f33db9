// SPDX-License-Identifier: BSD-3-Clause
// Drives the fuzz target of the client library without a fuzzer: two valid frames with random changes, or the files of the
// command line.
#include <cstdio>
#include <fstream>
#include <iterator>

#include "tests/fuzz/client_fuzz.h"
#include "tests/fuzz/mutation.h"
#include "tests/support/frame_messages.h"

namespace stereod {
namespace {

template <typename Message>
void append(Bytes& to, std::uint8_t channel, const Message& message) {
  Bytes bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  to.push_back(channel);
  to.push_back(static_cast<std::uint8_t>(bytes.size() & 0xFF));
  to.push_back(static_cast<std::uint8_t>(bytes.size() >> 8));
  to.insert(to.end(), bytes.begin(), bytes.end());
}

Bytes two_frames() {
  Bytes seed;
  append(seed, 2, camera_info_of());
  for (const std::int64_t frame : {4, 5}) {
    for (int y = 0; y < kHeight; y += kRowsPerMessage) {
      disparity_rows_t rows = rows_of(frame, y);
      rows.left = 20;
      rows.decimation_y = 2;
      if (y >= 4) mark_filled(rows, [](int x, int) { return x % 3 == 0; });
      if (y >= 6) {
        rows.confidence.assign(static_cast<std::size_t>(rows.width * rows.row_count), 200);
        rows.confidence_size = static_cast<std::int32_t>(rows.confidence.size());
      }
      append(seed, 0, rows);
    }
    append(seed, 1, summary_of(frame));
  }
  return seed;
}

}  // namespace
}  // namespace stereod

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    std::ifstream in(argv[i], std::ios::binary);
    const stereod::Bytes bytes{std::istreambuf_iterator<char>(in), {}};
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  if (argc > 1) return 0;
  const stereod::Bytes seed = stereod::two_frames();
  LLVMFuzzerTestOneInput(seed.data(), seed.size());
  if (stereod::frames_of_last_input != 2) {
    std::fprintf(stderr, "the unchanged input makes %d frames, expected 2\n", stereod::frames_of_last_input);
    return 1;
  }
  constexpr int kRounds = 50'000;
  stereod::Random random(12);
  int frames = 0;
  for (int round = 0; round < kRounds; ++round) {
    stereod::Bytes bytes = seed;
    stereod::mutate(bytes, random, bytes.size());
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
    frames += stereod::frames_of_last_input;
  }
  std::printf("%d inputs, %d frames\n", kRounds, frames);
  return frames > 0 ? 0 : 1;
}
