// SPDX-License-Identifier: BSD-3-Clause
// Drives the fuzz target without a fuzzer: whole inputs, and the same inputs changed here and there, always
// the same ones. Any input may also be given as a file.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <vector>

#include "tests/fuzz/camera_frame_fuzz.h"
#include "tests/fuzz/mutation.h"
#include "tests/support/camera_jpeg.h"

namespace stereod {
namespace {

/// Inputs that are taken for frames, one of each format.
std::vector<Bytes> seeds() {
  std::vector<Bytes> seeds;
  for (std::uint8_t format = 0; format < 9; ++format) {
    // Head: format, 48×24, no padding, a good timestamp.
    Bytes seed = {format, 2, 2, 0, 2 | 4 | 8, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    const bool jpeg = format >= 7;
    const Bytes body = jpeg ? camera_jpeg({48, 24}, -1) : Bytes(48 * 24 * 2, 90);
    const Bytes bare = format == 8 ? without_huffman_tables(body) : body;
    seed.insert(seed.end(), bare.begin(), bare.end());
    seeds.push_back(seed);
  }
  return seeds;
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
  constexpr int kRounds = 4000;
  stereod::Random random(11);
  int inputs = 0, frames = 0;
  for (const stereod::Bytes& seed : stereod::seeds()) {
    // Twice: what an input before it left in the decoder may cost one image, not more.
    for (int i = 0; i < 2; ++i) LLVMFuzzerTestOneInput(seed.data(), seed.size());
    if (!stereod::last_input_was_a_frame) {
      std::fprintf(stderr, "the input of format %d is no frame, so that changing it tests nothing\n",
                   seed[0]);
      return 1;
    }
    for (int round = 0; round < kRounds; ++round, ++inputs) {
      stereod::Bytes bytes = seed;
      stereod::mutate(bytes, random, 16);
      LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
      frames += stereod::last_input_was_a_frame ? 1 : 0;
    }
  }
  std::printf("%d inputs, of which %d were frames all the same\n", inputs, frames);
  return 0;
}
