// SPDX-License-Identifier: BSD-3-Clause
// Writes and reads configuration files for tests.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "daemon/config/config.h"
#include "tests/support/image_files.h"
#include "tests/support/temporary_directory.h"

namespace stereod {

class ConfigFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) {
    const std::filesystem::path file = directory_ / "stereod.yaml";
    std::ofstream(file) << text;
    return file;
  }
  Config read(const std::string& text) { return read_config(write(text)); }

  /// Returns the error without the directory's name before the file's.
  std::string error_of(const std::string& text) {
    const std::string sentence = file_error_of([&] { read(text); });
    const std::string directory = directory_.path().string() + "/";
    return sentence.rfind(directory, 0) == 0 ? sentence.substr(directory.size()) : sentence;
  }

  TemporaryDirectory directory_;
};

}  // namespace stereod
