// A headless Chromium that a test looks at a page with.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>

namespace stereod {

/// Speaks Chromium's own protocol over a pipe: no port is opened. Ended by the destructor.
class Chromium {
 public:
  /// Nothing if there is no Chromium here. `scratch`: for its profile.
  static std::optional<std::filesystem::path> program();
  Chromium(const std::filesystem::path& program, const std::filesystem::path& scratch);
  ~Chromium();
  Chromium(const Chromium&) = delete;
  Chromium& operator=(const Chromium&) = delete;

  /// Throws std::runtime_error if Chromium does not answer.
  void open(const std::string& url, int width, int height);
  /// The text that a JavaScript expression (or promise) gives. Throws std::runtime_error with Chromium's
  /// answer if it gives none.
  std::string evaluate(const std::string& expression);
  /// The visible page as PNG.
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
