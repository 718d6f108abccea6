// A shared library opened at run time with local symbols.
#pragma once

#include <dlfcn.h>

#include <string>

#include "engine/base/check.h"

namespace sunder::render {

/// A shared library that is never closed, because drivers leave threads and exit handlers behind.
class Library {
 public:
  /// Opens a library. Throws InputError that names it on failure.
  explicit Library(const char* name) : handle_(::dlopen(name, RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr) throw InputError(std::string(name) + ": " + ::dlerror());
  }

  /// Returns a symbol, or null if the library does not have it.
  template <class Function>
  Function find(const char* symbol) const {
    return reinterpret_cast<Function>(::dlsym(handle_, symbol));
  }

 private:
  void* handle_;
};

}  // namespace sunder::render
