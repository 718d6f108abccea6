// Command-line options of the benchmark programs that print their own tables.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <initializer_list>
#include <string>
#include <string_view>
#include <variant>

namespace sunder::bench {

/// An option and the variable that receives its value; an option for a bool takes no value.
struct Flag {
  std::string_view name;
  std::variant<bool*, int*, double*, std::string*> value;
};

/// Reads the options into their variables. Returns false for an unknown option or a missing value.
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
