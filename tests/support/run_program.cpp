// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/run_program.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

namespace stereod {
namespace {

std::string content_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

int wait_for(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return -1;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

std::vector<std::string> starter_of(const std::filesystem::path& program) {
  std::vector<std::string> words;
  if (program.parent_path() == STEREOD_BIN_DIR) {
    std::istringstream emulator(STEREOD_EMULATOR);
    for (std::string word; emulator >> word;) words.push_back(word);
  }
  words.push_back(program.string());
  return words;
}

ChildProgram::ChildProgram(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                           const std::filesystem::path& scratch)
    : out_(scratch / (program.filename().string() + ".out")),
      err_(scratch / (program.filename().string() + ".err")) {
  std::vector<std::string> words = starter_of(program);
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  constexpr int kWrite = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out_.c_str(), kWrite, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err_.c_str(), kWrite, 0600);
  if (::posix_spawnp(&child_, argv[0], &actions, nullptr, argv.data(), environ) != 0) child_ = 0;
  posix_spawn_file_actions_destroy(&actions);
}

ChildProgram::~ChildProgram() {
  if (child_ == 0) return;
  send(SIGKILL);
  wait_for(child_);
}

void ChildProgram::send(int signal) const {
  if (child_ != 0) ::kill(child_, signal);
}

ProgramRun ChildProgram::wait() {
  ProgramRun run;
  if (child_ == 0) return run;
  run.status = wait_for(std::exchange(child_, 0));
  run.out = content_of(out_);
  run.err = content_of(err_);
  return run;
}

std::string ChildProgram::out_so_far() const { return content_of(out_); }

std::string ChildProgram::err_so_far() const { return content_of(err_); }

ProgramRun run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                       const std::filesystem::path& scratch) {
  return ChildProgram(program, arguments, scratch).wait();
}

}  // namespace stereod
