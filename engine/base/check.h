// Errors: a failed SUNDER_CHECK (a bug) aborts the program, bad input throws an InputError, and a
// file or folder that cannot be written throws a FileError.
#pragma once

#include <stdexcept>
#include <string>

namespace sunder {

/// Bad input from the user. `what()` names the file, the line if known, and the remedy. The program
/// prints it and exits with code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file or folder that cannot be written. `what()` names the path and the reason. The input is
/// not at fault, so the program exits with code 1.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Prints the failed condition with its file and line, and aborts.
[[noreturn]] void check_failed(const char* condition, const char* file, int line);

}  // namespace sunder

/// Aborts if a condition is false that only a bug can violate. Checked in every build type.
#define SUNDER_CHECK(condition) \
  ((condition) ? static_cast<void>(0) : ::sunder::check_failed(#condition, __FILE__, __LINE__))
