// SPDX-License-Identifier: BSD-3-Clause
// A headless Chromium for tests of web pages.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>

namespace stereod {

/// Controls Chromium with its DevTools protocol over a pipe; opens no port. The destructor ends Chromium.
class Chromium {
 public:
  /// Returns the path of an installed Chromium or Chrome.
  static std::optional<std::filesystem::path> program();
  /// Starts @p program with its profile in @p scratch. @throws std::runtime_error if it cannot be started.
  Chromium(const std::filesystem::path& program, const std::filesystem::path& scratch);
  ~Chromium();
  Chromium(const Chromium&) = delete;
  Chromium& operator=(const Chromium&) = delete;

  /// Opens @p url in a window of this size [px]. @throws std::runtime_error if Chromium does not answer within 60 s.
  void open(const std::string& url, int width, int height);
  /// Returns the value of a JavaScript expression or promise as text.
  /// @throws std::runtime_error with Chromium's answer if the expression fails.
  std::string evaluate(const std::string& expression);
  /// Writes the visible page as PNG.
  void screenshot(const std::filesystem::path& file);

 private:
  std::string call(const std::string& method, const std::string& parameters);
  std::string read_message();

  pid_t child_ = 0;
  int to_ = -1, from_ = -1;
  int last_id_ = 0;
  std::string session_;
  std::string buffer_;
};

}  // namespace stereod
