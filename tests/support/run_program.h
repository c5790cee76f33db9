// Programs as a test's children.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace stereod {

/// The words that start a program: its path; before it, if it was built beside the tests and is foreign to
/// this machine, the emulator that runs the tests themselves.
std::vector<std::string> starter_of(const std::filesystem::path& program);

struct ProgramRun {
  int status = -1;  ///< exit status; 128 + the signal if one ended it; -1 if it could not be started
  std::string out;
  std::string err;
};

/// A program that runs beside the test, without input. Its output goes to files in `scratch`. Still running
/// at the end of the test, it is killed.
class ChildProgram {
 public:
  ChildProgram(const std::filesystem::path& program, const std::vector<std::string>& arguments,
               const std::filesystem::path& scratch);
  ~ChildProgram();
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  void send(int signal) const;
  /// Waits for its end.
  ProgramRun wait();
  /// What it has written to stderr so far.
  std::string err_so_far() const;
  /// The same of stdout.
  std::string out_so_far() const;

 private:
  std::filesystem::path out_, err_;
  pid_t child_ = 0;  // 0: not running
};

/// Runs a program to its end.
ProgramRun run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                       const std::filesystem::path& scratch);

}  // namespace stereod
