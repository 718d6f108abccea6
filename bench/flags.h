// The command lines of benchmarks that print tables of their own.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <initializer_list>
#include <string>
#include <string_view>
#include <variant>

namespace sunder::bench {

/// A flag, and where its value goes; one that goes to a bool has none.
struct Flag {
  std::string_view name;
  std::variant<bool*, int*, double*, std::string*> value;
};

/// False for what is none of `flags`, and for a value that is missing.
inline bool read_flags(int argc, char** argv, std::initializer_list<Flag> flags) {
  for (int i = 1; i < argc; ++i) {
    const auto flag = std::find_if(flags.begin(), flags.end(),
                                   [&](const Flag& known) { return known.name == argv[i]; });
    if (flag == flags.end()) return false;
    if (bool* const* on = std::get_if<bool*>(&flag->value)) {
      **on = true;
      continue;
    }
    if (++i == argc) return false;
    if (int* const* whole = std::get_if<int*>(&flag->value)) **whole = std::atoi(argv[i]);
    if (double* const* real = std::get_if<double*>(&flag->value)) **real = std::atof(argv[i]);
    if (std::string* const* text = std::get_if<std::string*>(&flag->value)) **text = argv[i];
  }
  return true;
}

}  // namespace sunder::bench
