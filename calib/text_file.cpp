#include "calib/text_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <set>
#include <string>
#include <system_error>

#include "daemon/config/file_error.h"

namespace stereod {

void require_writable(const std::filesystem::path& file) {
  std::error_code error;
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  if (!std::filesystem::is_directory(folder, error)) {
    throw FileError(file.string() + ": cannot be written: there is no folder " + folder.string());
  }
  if (std::filesystem::is_directory(file, error)) {
    throw FileError(file.string() + ": cannot be written: this is a folder");
  }
  if (::access(folder.c_str(), W_OK) != 0) {
    throw FileError(file.string() + ": cannot be written: " + std::strerror(errno));
  }
}

void require_distinct(const std::vector<std::filesystem::path>& files) {
  std::set<std::filesystem::path> seen;
  for (const std::filesystem::path& file : files) {
    std::error_code error;
    const auto place = std::filesystem::weakly_canonical(std::filesystem::absolute(file), error);
    if (!seen.insert(error ? file : place).second) {
      throw FileError(file.string() +
                      ": is named twice, and would be overwritten; give each file a name of its own");
    }
  }
}

void write_text_file(const std::filesystem::path& file, std::string_view text) {
  require_writable(file);
  const std::filesystem::path temporary = file.string() + "." + std::to_string(::getpid()) + ".new";
  std::ofstream out(temporary, std::ios::binary);
  out << text;
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(temporary, file, error);
  if (!out || error) {
    const std::string why = error ? error.message() : std::strerror(errno);
    std::filesystem::remove(temporary, error);
    throw FileError(file.string() + ": cannot be written: " + why);
  }
}

}  // namespace stereod
