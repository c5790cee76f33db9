// SPDX-License-Identifier: BSD-3-Clause
// Messages are decoded in one place, where their layout is checked first.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace stereod {
namespace {

namespace fs = std::filesystem;

bool is_allowed(const std::string& file) {
  return file.starts_with("daemon/client/") || file == "daemon/lcm/message_decoder.h";
}

/// Returns true if the text calls decode() of a generated message: with bytes, the offset 0 and a size.
bool calls_generated_decode(const std::string& text) {
  static const std::regex call_begin(R"((\.|->)decode\()"), offset(R"(,\s*0\s*,)");
  for (auto at = std::sregex_iterator(text.begin(), text.end(), call_begin); at != std::sregex_iterator();
       ++at) {
    const auto begin = static_cast<std::size_t>(at->position());
    const std::string call = text.substr(begin, text.find(';', begin) - begin);
    if (std::regex_search(call, offset)) return true;
  }
  return false;
}

TEST(MessageDecoder, GeneratedDecode_CalledInOnePlace) {
  const fs::path root = STEREOD_SOURCE_DIR;
  std::vector<std::string> callers;
  int files = 0;
  for (const char* directory : {"core", "daemon", "calib", "tests"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / directory)) {
      const std::string name = entry.path().lexically_relative(root).generic_string();
      if (!(name.ends_with(".h") || name.ends_with(".cpp"))) continue;
      ++files;
      std::ifstream in(entry.path());
      const std::string text{std::istreambuf_iterator<char>(in), {}};
      if (!is_allowed(name) && calls_generated_decode(text)) callers.push_back(name);
    }
  }
  EXPECT_GT(files, 300) << "the sources are not where they should be";
  for (const std::string& caller : callers) ADD_FAILURE() << caller << ": use decode_message()";
}

}  // namespace
}  // namespace stereod
