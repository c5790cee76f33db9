// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tools/tap/tap.h"

#include <cstdio>

namespace stereod::tools {

void print_error(const std::string& message) { std::fprintf(stderr, "stereo-tap: %s\n", message.c_str()); }

}  // namespace stereod::tools
