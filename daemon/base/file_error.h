// What is thrown when a file cannot be used.
#pragma once

#include <stdexcept>

namespace stereod {

/// A file that is missing, unreadable or not what it should be. what() is one sentence: the file, what was
/// found, what is allowed.
class FileError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace stereod
