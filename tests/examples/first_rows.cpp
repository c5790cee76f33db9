// SPDX-License-Identifier: BSD-3-Clause
// Reacts to rows while the rest of the frame is still being matched, in an event loop with poll().
//   example_first_rows BLOCKS [PREFIX]
#include <poll.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

#include "daemon/client/stereod_client.h"

int main(int argc, char** argv) {
  int blocks = argc > 1 ? std::atoi(argv[1]) : 100;
  stereod::StereoClient::Options options;
  if (argc > 2) options.prefix = argv[2];
  try {
    stereod::StereoClient client(options);
    client.on_rows([&](const stereod::RowBlock& block) {
      const stereod::disparity_rows_t& m = block.message();
      int valid = 0;
      for (int y = m.first_row; y < m.first_row + m.row_count; ++y) {
        for (int x = 0; x < m.width; ++x) valid += block.at(x, y) != stereod::DisparityMap::kNone ? 1 : 0;
      }
      std::printf("frame %lld rows %d to %d: %d of %d pixels have a disparity\n",
                  static_cast<long long>(m.frame), m.first_row, m.first_row + m.row_count - 1, valid,
                  m.width * m.row_count);
      --blocks;
    });
    pollfd waiting{client.file_descriptor(), POLLIN, 0};
    while (blocks > 0 && poll(&waiting, 1, -1) > 0) client.handle(0);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
