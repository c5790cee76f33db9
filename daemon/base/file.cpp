// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

namespace stereod {

namespace {

namespace fs = std::filesystem;

constexpr mode_t kNewFileMode = 0644;
constexpr int kMaxLinks = 40;  // the kernel's limit

/// Closes a file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  int close() { return ::close(std::exchange(fd_, -1)); }

 private:
  int fd_;
};

/// Removes a file at the end of the scope, unless keep() was called.
class ScopedFile {
 public:
  explicit ScopedFile(std::string path) : path_(std::move(path)) {}
  ~ScopedFile() {
    if (!kept_) ::unlink(path_.c_str());
  }
  ScopedFile(const ScopedFile&) = delete;
  ScopedFile& operator=(const ScopedFile&) = delete;
  void keep() { kept_ = true; }

 private:
  std::string path_;
  bool kept_ = false;
};

std::string error_text(int error) { return std::generic_category().message(error); }

[[noreturn]] void throw_unreadable(const fs::path& path, int error) {
  if (error == ENOENT || error == ENOTDIR) throw FileError(path.string() + ": the file does not exist");
  throw FileError(path.string() + ": the file cannot be read (" + error_text(error) + ")");
}

[[noreturn]] void throw_unwritable(const fs::path& path, int error) {
  throw FileError(path.string() + ": the file cannot be written (" + error_text(error) + ")");
}

[[noreturn]] void throw_too_large(const fs::path& path, std::size_t max_bytes) {
  throw FileError(path.string() + ": the file is larger than " + std::to_string(max_bytes) +
                  " bytes, the maximum that is read");
}

/// Appends the file to @p content, a std::string or a std::vector of bytes.
template <typename Content>
void read_into(Content& content, const fs::path& path, std::size_t max_bytes) {
  // O_NONBLOCK: opening a pipe would wait for a writer.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) throw_unreadable(path, errno);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) throw_unreadable(path, errno);
  if (S_ISDIR(status.st_mode)) throw FileError(path.string() + ": is a directory; a file is needed");
  if (!S_ISREG(status.st_mode)) {
    throw FileError(path.string() + ": is a device, pipe or socket; a regular file is needed");
  }
  if (status.st_size > static_cast<off_t>(max_bytes)) throw_too_large(path, max_bytes);

  for (;;) {
    // One byte more than the size, so that the end of the file is seen in the same round.
    const std::size_t size = content.size();
    const auto expected = static_cast<std::size_t>(status.st_size) + 1;
    content.resize(size < expected ? expected : size + 65536);
    const ssize_t count = ::read(file.get(), content.data() + size, content.size() - size);
    const int error = errno;
    content.resize(size + (count > 0 ? static_cast<std::size_t>(count) : 0));
    if (count == 0) return;
    if (count < 0 && error != EINTR) throw_unreadable(path, error);
    if (content.size() > max_bytes) throw_too_large(path, max_bytes);
  }
}

/// Returns the path that writing to @p path replaces: the end of a chain of links, which need not exist.
fs::path target_of(const fs::path& path) {
  fs::path target = path;
  std::error_code error;
  for (int links = 0; fs::is_symlink(target, error); ++links) {
    if (links == kMaxLinks) throw FileError(path.string() + ": the symbolic link leads in a circle");
    const fs::path next = fs::read_symlink(target, error);
    if (error) throw_unwritable(path, error.value());
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  return target;
}

fs::path directory_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : "."; }

struct Target {
  fs::path path;
  std::optional<mode_t> mode;  ///< of the file that is replaced
};

Target writable_target(const fs::path& path) {
  Target target{target_of(path), {}};
  const fs::path directory = directory_of(target.path);
  struct stat status {};
  if (::stat(directory.c_str(), &status) != 0 || !S_ISDIR(status.st_mode)) {
    throw FileError(path.string() + ": the directory to write to does not exist" +
                    (target.path == path ? "" : " (" + directory.string() + ")"));
  }
  if (::stat(target.path.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) {
      throw FileError(path.string() + ": is a directory; name a file to write to");
    }
    // rename() would replace the device itself.
    if (!S_ISREG(status.st_mode)) {
      throw FileError(path.string() + ": is a device, pipe or socket; only regular files are written");
    }
    target.mode = status.st_mode & 07777;
  }
  if (::access(directory.c_str(), W_OK) != 0) throw_unwritable(path, errno);
  return target;
}

void write_all(int fd, std::span<const std::uint8_t> bytes, const fs::path& path) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(fd, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw_unwritable(path, errno);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

/// Makes the renaming of a file in @p directory survive a power cut, where the file system can.
void sync_directory(const fs::path& directory) {
  const Descriptor opened(::open(directory.c_str(), O_RDONLY | O_CLOEXEC | O_DIRECTORY));
  if (opened.get() >= 0) ::fsync(opened.get());
}

}  // namespace

std::vector<std::uint8_t> read_file_bytes(const fs::path& path, std::size_t max_bytes) {
  std::vector<std::uint8_t> bytes;
  read_into(bytes, path, max_bytes);
  if (bytes.empty()) throw FileError(path.string() + ": the file is empty");
  return bytes;
}

std::string read_text_file(const fs::path& path, std::size_t max_bytes) {
  std::string text;
  read_into(text, path, max_bytes);
  return text;
}

void write_file_bytes(const fs::path& path, std::span<const std::uint8_t> bytes) {
  const Target target = writable_target(path);
  static std::atomic<unsigned> counter{0};
  const std::string temporary =
      target.path.string() + ".tmp-" + std::to_string(::getpid()) + "-" + std::to_string(counter++);
  Descriptor file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kNewFileMode));
  if (file.get() < 0) throw_unwritable(path, errno);
  ScopedFile unfinished(temporary);
  write_all(file.get(), bytes, path);
  if (target.mode && ::fchmod(file.get(), *target.mode) != 0) throw_unwritable(path, errno);
  // Before the rename: a power cut after it must not leave an empty file.
  if (::fsync(file.get()) != 0) throw_unwritable(path, errno);
  if (file.close() != 0) throw_unwritable(path, errno);
  if (::rename(temporary.c_str(), target.path.c_str()) != 0) throw_unwritable(path, errno);
  unfinished.keep();
  sync_directory(directory_of(target.path));
}

void write_text_file(const fs::path& path, std::string_view text) {
  write_file_bytes(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void require_writable(const fs::path& path) { writable_target(path); }

void require_distinct(const std::vector<fs::path>& written, const std::vector<fs::path>& read) {
  const auto location_of = [](const fs::path& path) {
    std::error_code error;
    const fs::path location = fs::weakly_canonical(fs::absolute(target_of(path)), error);
    return error ? path : location;
  };
  std::set<fs::path> seen;
  for (const fs::path& path : read) {
    if (!path.empty()) seen.insert(location_of(path));
  }
  for (const fs::path& path : written) {
    if (!path.empty() && !seen.insert(location_of(path)).second) {
      throw FileError(path.string() + ": is named twice and would be overwritten; name a different file");
    }
  }
}

}  // namespace stereod
