// SPDX-License-Identifier: BSD-3-Clause
// Runs programs as child processes of a test.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace stereod {

/// Returns the command line that starts @p program: its path, preceded by the emulator that runs the tests if the
/// program was cross-compiled with them.
std::vector<std::string> starter_of(const std::filesystem::path& program);

struct ProgramRun {
  int status = -1;  ///< exit status; 128 + signal number if a signal ended it; -1 if it could not be started
  std::string out;
  std::string err;
};

/// A program that runs concurrently with the test, with empty standard input and its output in files in @p scratch.
/// The destructor kills it if it still runs.
class ChildProgram {
 public:
  ChildProgram(const std::filesystem::path& program, const std::vector<std::string>& arguments,
               const std::filesystem::path& scratch);
  ~ChildProgram();
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  void send(int signal) const;
  /// Waits until the program has ended.
  ProgramRun wait();
  /// Returns the output to stderr so far.
  std::string err_so_far() const;
  /// Returns the output to stdout so far.
  std::string out_so_far() const;

 private:
  std::filesystem::path out_, err_;
  pid_t child_ = 0;  // 0: not running
};

/// Runs a program and waits until it has ended.
ProgramRun run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                       const std::filesystem::path& scratch);

}  // namespace stereod
