// SPDX-License-Identifier: BSD-3-Clause
// Tests reading and writing whole files.
#include "daemon/base/file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/image_files.h"
#include "tests/support/temporary_directory.h"

namespace stereod {
namespace {

namespace fs = std::filesystem;

class File : public testing::Test {
 protected:
  fs::path path(const char* name) const { return directory_ / name; }
  std::string text(const char* name) const { return read_text_file(path(name), 1000); }
  long files() const { return std::distance(fs::directory_iterator(directory_.path()), {}); }
  static unsigned mode_of(const fs::path& file) {
    struct stat status {};
    EXPECT_EQ(::stat(file.c_str(), &status), 0);
    return status.st_mode & 07777;
  }
  TemporaryDirectory directory_;
};

TEST_F(File, Written_ReadsBack) {
  const std::vector<std::uint8_t> bytes{0, 255, 10, 13};
  write_file_bytes(path("a"), bytes);
  EXPECT_EQ(read_file_bytes(path("a")), bytes);
  write_text_file(path("a"), "shorter");
  EXPECT_EQ(text("a"), "shorter");
  EXPECT_EQ(files(), 1) << "no temporary stays";
}

TEST_F(File, EmptyFile_IsTextButNoBytes) {
  write_text_file(path("empty"), "");
  EXPECT_EQ(text("empty"), "");
  EXPECT_EQ(file_error_of([&] { read_file_bytes(path("empty")); }),
            path("empty").string() + ": the file is empty");
}

TEST_F(File, LargerThanAllowed_IsRefused) {
  write_text_file(path("a"), "12345");
  EXPECT_EQ(read_text_file(path("a"), 5), "12345");
  const std::string sentence =
      path("a").string() + ": the file is larger than 4 bytes, the maximum that is read";
  EXPECT_EQ(file_error_of([&] { read_text_file(path("a"), 4); }), sentence);
  EXPECT_EQ(file_error_of([&] { read_file_bytes(path("a"), 4); }), sentence);
  // A file of the kernel's, which has no size before it is read.
  EXPECT_NE(file_error_of([&] { read_text_file("/proc/self/status", 4); }).find("larger than 4 bytes"),
            std::string::npos);
  EXPECT_GT(read_text_file("/proc/self/status", 1'000'000).size(), 4U);
}

TEST_F(File, NoRegularFile_IsRefusedWithoutBlocking) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  for (const fs::path& file : {path("pipe"), fs::path("/dev/zero")}) {
    const std::string start = file.string() + ": is a device, pipe or socket; ";
    EXPECT_EQ(file_error_of([&] { read_file_bytes(file); }), start + "a regular file is needed");
    EXPECT_EQ(file_error_of([&] { read_text_file(file, 10); }), start + "a regular file is needed");
    EXPECT_EQ(file_error_of([&] { write_text_file(file, "x"); }), start + "only regular files are written");
    EXPECT_EQ(file_error_of([&] { require_writable(file); }), start + "only regular files are written");
  }
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
  EXPECT_TRUE(fs::is_character_file("/dev/zero"));
  const std::string directory = directory_.path().string();
  EXPECT_EQ(file_error_of([&] { read_file_bytes(directory); }),
            directory + ": is a directory; a file is needed");
  EXPECT_EQ(file_error_of([&] { write_text_file(directory, "x"); }),
            directory + ": is a directory; name a file to write to");
}

TEST_F(File, MissingFileOrDirectory_IsNamed) {
  EXPECT_EQ(file_error_of([&] { read_file_bytes(path("no/a")); }),
            path("no/a").string() + ": the file does not exist");
  EXPECT_EQ(file_error_of([&] { write_text_file(path("no/a"), "x"); }),
            path("no/a").string() + ": the directory to write to does not exist");
}

TEST_F(File, NewFile_Has0644LessTheUmask) {
  const mode_t before = ::umask(022);
  write_text_file(path("a"), "x");
  ::umask(027);
  write_text_file(path("b"), "x");
  ::umask(before);
  EXPECT_EQ(mode_of(path("a")), 0644U);
  EXPECT_EQ(mode_of(path("b")), 0640U);
}

TEST_F(File, ReplacedFile_KeepsItsMode) {
  write_text_file(path("a"), "old");
  for (const mode_t mode : {0600U, 0666U}) {
    ASSERT_EQ(::chmod(path("a").c_str(), mode), 0);
    write_text_file(path("a"), "new");
    EXPECT_EQ(mode_of(path("a")), mode);
  }
}

TEST_F(File, Link_StaysAndItsTargetIsReplaced) {
  fs::create_directory(path("real"));
  fs::create_symlink("middle", path("link"));
  fs::create_symlink("real/a", path("middle"));
  for (const char* content : {"first", "second"}) {  // the target is created, then replaced
    write_text_file(path("link"), content);
    EXPECT_TRUE(fs::is_symlink(path("link")));
    EXPECT_TRUE(fs::is_symlink(path("middle")));
    EXPECT_EQ(text("real/a"), content);
  }
  fs::create_symlink("circle", path("circle"));
  EXPECT_EQ(file_error_of([&] { write_text_file(path("circle"), "x"); }),
            path("circle").string() + ": the symbolic link leads in a circle");
  fs::create_symlink("nowhere/a", path("broken"));
  EXPECT_EQ(file_error_of([&] { write_text_file(path("broken"), "x"); }),
            path("broken").string() + ": the directory to write to does not exist (" +
                path("nowhere").string() + ")");
}

TEST_F(File, FailedWrite_KeepsTheOldContent) {
  write_text_file(path("a"), "old");
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{4, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string sentence = file_error_of([&] { write_text_file(path("a"), "newer"); });
  EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(sentence, path("a").string() + ": the file cannot be written (File too large)");
  EXPECT_EQ(text("a"), "old");
  EXPECT_EQ(files(), 1) << "no temporary stays";
}

TEST_F(File, RequireDistinct_FollowsLinks) {
  write_text_file(path("a"), "x");
  fs::create_symlink("a", path("link"));
  EXPECT_NO_THROW(require_distinct({path("a"), path("b"), ""}, {"", path("c")}));
  EXPECT_THROW(require_distinct({path("a"), path("link")}), FileError);
  EXPECT_THROW(require_distinct({path("link")}, {path("a")}), FileError);
  EXPECT_NO_THROW(require_distinct({path("b")}, {path("a"), path("link")}));
}

}  // namespace
}  // namespace stereod
