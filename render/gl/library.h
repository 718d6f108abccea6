// A shared library opened at run time, its symbols kept to itself.
#pragma once

#include <dlfcn.h>

#include <string>

#include "engine/base/check.h"

namespace sunder::render {

/// Never closed again: drivers leave threads and exit handlers behind.
class Library {
 public:
  /// Throws InputError naming the library if it is not there.
  explicit Library(const char* name) : handle_(::dlopen(name, RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr) throw InputError(std::string(name) + ": " + ::dlerror());
  }

  /// Null if the library has no such symbol.
  template <class Function>
  Function find(const char* symbol) const {
    return reinterpret_cast<Function>(::dlsym(handle_, symbol));
  }

 private:
  void* handle_;
};

}  // namespace sunder::render
