#include "daemon/base/text_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <set>
#include <string>
#include <system_error>

#include "daemon/base/file_error.h"

namespace stereod {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
  throw FileError(file.string() + ": cannot be written: " + why);
}

// What is really written where `file` is a link, which may point to nothing yet.
fs::path target_of(const fs::path& file) {
  constexpr int kMaxLinks = 40;  // as the kernel has it
  fs::path target = file;
  std::error_code error;
  for (int links = 0; fs::is_symlink(target, error); ++links) {
    if (links == kMaxLinks) refuse(file, "this is a link that leads in a circle");
    const fs::path next = fs::read_symlink(target, error);
    if (error) refuse(file, error.message());
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  return target;
}

fs::path directory_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : "."; }

fs::path writable_target(const fs::path& file) {
  const fs::path target = target_of(file);
  const fs::path directory = directory_of(target);
  std::error_code error;
  if (!fs::is_directory(directory, error)) refuse(file, "there is no directory " + directory.string());
  const fs::file_status there = fs::status(target, error);
  if (fs::is_directory(there)) refuse(file, "this is a directory");
  // Renaming a file to the name of a device would take the device's place.
  if (fs::exists(there) && !fs::is_regular_file(there))
    refuse(file, "this is a device or a pipe, not a file");
  if (::access(directory.c_str(), W_OK) != 0) refuse(file, std::strerror(errno));
  return target;
}

// A file that goes away with the object, unless it was renamed.
class TemporaryFile {
 public:
  TemporaryFile(const fs::path& file, const fs::path& target)
      : file_(file), target_(target), name_(target.string() + ".XXXXXX") {
    descriptor_ = ::mkostemp(name_.data(), O_CLOEXEC);
    if (descriptor_ < 0) refuse(file_, std::strerror(errno));
  }
  ~TemporaryFile() {
    ::close(descriptor_);
    if (!renamed_) ::unlink(name_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write(std::string_view text) {
    while (!text.empty()) {
      const ssize_t written = ::write(descriptor_, text.data(), text.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) refuse(file_, std::strerror(errno));
      text.remove_prefix(static_cast<std::size_t>(written));
    }
    // The daemon reads calibrations as another user. On the disk before the rename, or a power cut leaves an
    // empty file.
    if (::fchmod(descriptor_, 0644) != 0 || ::fsync(descriptor_) != 0) refuse(file_, std::strerror(errno));
  }

  void take_place() {
    if (::rename(name_.c_str(), target_.c_str()) != 0) refuse(file_, std::strerror(errno));
    renamed_ = true;
  }

 private:
  fs::path file_, target_;
  std::string name_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

}  // namespace

void require_writable(const fs::path& file) { writable_target(file); }

void require_distinct(const std::vector<fs::path>& written, const std::vector<fs::path>& read) {
  const auto place_of_file = [](const fs::path& file) {
    std::error_code error;
    const auto place = fs::weakly_canonical(fs::absolute(target_of(file)), error);
    return error ? file : place;
  };
  std::set<fs::path> seen;
  for (const fs::path& file : read) {
    if (!file.empty()) seen.insert(place_of_file(file));
  }
  for (const fs::path& file : written) {
    if (!file.empty() && !seen.insert(place_of_file(file)).second) {
      throw FileError(file.string() +
                      ": is named twice, and would be overwritten; give each file a name of its own");
    }
  }
}

void write_text_file(const fs::path& file, std::string_view text) {
  TemporaryFile temporary(file, writable_target(file));
  temporary.write(text);
  temporary.take_place();
}

}  // namespace stereod
