#include "daemon/tools/tap/tap.h"

#include <cstdio>

namespace stereod {

void complain(const std::string& sentence) { std::fprintf(stderr, "stereo-tap: %s\n", sentence.c_str()); }

}  // namespace stereod
