// What goes wrong: a programmer's mistake stops the program, a user's mistake is an InputError, and
// what the machine has no room or no leave for a FileError.
#pragma once

#include <stdexcept>
#include <string>

namespace sunder {

/// Bad input from the user: `what()` names the file, the line where known, and what to do.
/// The program prints it and exits with code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file or folder that cannot be written: `what()` names it and why. Nobody's input is wrong, so
/// the program exits with code 1.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Prints the failed condition with its place and aborts.
[[noreturn]] void check_failed(const char* condition, const char* file, int line);

}  // namespace sunder

/// A condition that only a bug can break; checked in every build.
#define SUNDER_CHECK(condition) \
  ((condition) ? static_cast<void>(0) : ::sunder::check_failed(#condition, __FILE__, __LINE__))
