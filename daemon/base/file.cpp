#include "daemon/base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <string>
#include <system_error>
#include <utility>

#include "daemon/base/file_error.h"

namespace stereod {

namespace {

constexpr std::size_t kMaxFile = std::size_t{1} << 30;

/// A file descriptor that closes itself.
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

/// Removes a file at the end of the scope unless told to keep it.
class RemovedUnlessKept {
 public:
  explicit RemovedUnlessKept(std::string path) : path_(std::move(path)) {}
  ~RemovedUnlessKept() {
    if (!kept_) ::unlink(path_.c_str());
  }
  RemovedUnlessKept(const RemovedUnlessKept&) = delete;
  RemovedUnlessKept& operator=(const RemovedUnlessKept&) = delete;
  void keep() { kept_ = true; }

 private:
  std::string path_;
  bool kept_ = false;
};

std::string words_for(int error) { return std::generic_category().message(error); }

[[noreturn]] void throw_unreadable(const std::filesystem::path& path, int error) {
  if (error == ENOENT || error == ENOTDIR) throw FileError(path.string() + ": the file does not exist");
  throw FileError(path.string() + ": the file cannot be read (" + words_for(error) + ")");
}

[[noreturn]] void throw_unwritable(const std::filesystem::path& path, int error) {
  throw FileError(path.string() + ": the file cannot be written (" + words_for(error) + ")");
}

void write_all(int fd, std::span<const std::uint8_t> bytes, const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw_unwritable(path, errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

}  // namespace

std::vector<std::uint8_t> read_file_bytes(const std::filesystem::path& path) {
  // Without O_NONBLOCK, opening a pipe would wait for somebody to write to it.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) throw_unreadable(path, errno);
  struct stat found {};
  if (::fstat(file.get(), &found) != 0) throw_unreadable(path, errno);
  if (S_ISDIR(found.st_mode)) throw FileError(path.string() + ": is a directory; a file is needed");
  if (!S_ISREG(found.st_mode)) {
    throw FileError(path.string() + ": is a device, pipe or socket; a regular file is needed");
  }

  std::vector<std::uint8_t> bytes;
  for (;;) {
    if (bytes.size() > kMaxFile || found.st_size > static_cast<off_t>(kMaxFile)) {
      throw FileError(path.string() + ": the file is larger than 1 GiB, the most that is read");
    }
    // One byte more than expected, so that the end of the file is met in the same round.
    const std::size_t have = bytes.size();
    const auto expected = static_cast<std::size_t>(found.st_size) + 1;
    bytes.resize(have < expected ? expected : have + 65536);
    const ssize_t got = ::read(file.get(), bytes.data() + have, bytes.size() - have);
    const int error = errno;
    bytes.resize(have + (got > 0 ? static_cast<std::size_t>(got) : 0));
    if (got == 0) break;
    if (got < 0 && error != EINTR) throw_unreadable(path, error);
  }
  if (bytes.empty()) throw FileError(path.string() + ": the file is empty");
  return bytes;
}

void write_file_bytes(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  std::filesystem::path target = path;
  struct stat found {};
  if (::stat(path.c_str(), &found) == 0) {
    if (S_ISDIR(found.st_mode)) throw FileError(path.string() + ": is a directory; name a file to write to");
    if (!S_ISREG(found.st_mode)) {
      throw FileError(path.string() + ": is a device, pipe or socket; only regular files are written");
    }
    // A link stays a link: the file that it leads to is replaced.
    std::error_code unresolved;
    const std::filesystem::path resolved = std::filesystem::canonical(path, unresolved);
    if (!unresolved) target = resolved;
  }

  static std::atomic<unsigned> written_before{0};
  const std::string temporary =
      target.string() + ".tmp-" + std::to_string(::getpid()) + "-" + std::to_string(written_before++);
  Descriptor file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (file.get() < 0) {
    if (errno == ENOENT) throw FileError(path.string() + ": the directory to write to does not exist");
    throw_unwritable(path, errno);
  }
  RemovedUnlessKept half_written(temporary);
  write_all(file.get(), bytes, path);
  if (file.close() != 0) throw_unwritable(path, errno);
  if (::rename(temporary.c_str(), target.c_str()) != 0) throw_unwritable(path, errno);
  half_written.keep();
}

}  // namespace stereod
