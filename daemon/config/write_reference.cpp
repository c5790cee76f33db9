// SPDX-License-Identifier: BSD-3-Clause
// Writes etc/stereod.yaml and docs/man/stereod.yaml.5 after a change of an option: write_reference SOURCE-DIRECTORY
#include <cstdio>
#include <exception>
#include <filesystem>

#include "daemon/base/file.h"
#include "daemon/config/reference.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: write_reference SOURCE-DIRECTORY\n", stderr);
    return 2;
  }
  try {
    const std::filesystem::path root = argv[1];
    stereod::write_text_file(root / "etc/stereod.yaml", stereod::reference_yaml());
    stereod::write_text_file(root / "docs/man/stereod.yaml.5", stereod::reference_man_page());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "write_reference: %s\n", error.what());
    return 1;
  }
  return 0;
}
