// A progress bar for people who wait.
#pragma once

#include <cstddef>
#include <string>

namespace stereod {

/// Draws itself on stderr if that is a terminal, and wipes itself off at the end; else it is silent.
class Progress {
 public:
  Progress(std::string what, std::size_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void step();

 private:
  void draw() const;

  std::string what_;
  std::size_t total_;
  std::size_t done_ = 0;
  bool shown_;
};

/// "[#####.....]": `done` of `total` parts of `width` characters.
std::string progress_bar(std::size_t done, std::size_t total, std::size_t width);

}  // namespace stereod
