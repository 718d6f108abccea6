// A command of the program with its options, their allowed values, and the files they name. Only
// this file, subcommand.cpp, manual.cpp and command_line.cpp use CLI11.
#pragma once

#include <charconv>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>

#include "scenes/app/arguments.h"

namespace sunder::app {

using Command = std::function<int()>;
inline constexpr int kMaxFrames = 1000000;

/// Returns a validator for a number from low to high. Unlike CLI::Range, it rejects NaN.
template <class Number>
CLI::Validator from_to(Number low, Number high) {
  const auto name = [](Number number) {
    std::ostringstream text;
    text << number;
    return text.str();
  };
  const std::string expected =
      (std::is_integral_v<Number> ? "a whole number from " : "a number from ") + name(low) +
      " to " + name(high);
  return CLI::Validator(
      [=](const std::string& text) {
        Number number{};
        const char* const end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data(), end, number);
        const bool good = error == std::errc() && stop == end && number >= low && number <= high;
        return good ? std::string() : "expected " + expected + ", not " + text;
      },
      name(low) + " - " + name(high));
}

/// Throws InputError, with similar names, for an unknown command or subcommand, and for an option
/// that the command does not have. `of`: the words of the command line before `words`.
void check_words(const CLI::App& program, std::span<char*> words,
                 const std::string& of = "sunder ");

/// The options of a command that name files.
struct FileOptions {
  using Paths = std::variant<const std::string*, const std::vector<std::string>*>;
  struct Option {
    const char* name;
    Paths paths;
    bool replaces_folder = false;
  };
  std::vector<Option> writes, reads;

  static std::vector<NamedFile> named(const std::vector<Option>& options) {
    std::vector<NamedFile> all;
    for (const Option& option : options) {
      const auto add = [&](const std::string& path) {
        all.push_back({option.name, path, option.replaces_folder});
      };
      if (const auto* one = std::get_if<const std::string*>(&option.paths)) {
        add(**one);
      } else {
        for (const std::string& path : *std::get<1>(option.paths)) add(path);
      }
    }
    return all;
  }
  void check() const { check_files(named(writes), named(reads)); }
};

/// A subcommand with its options. If the command line names it, parsing sets `chosen` to a call of
/// `work` with the options.
template <class Options>
struct Subcommand {
  CLI::App* app;
  std::shared_ptr<Options> options = std::make_shared<Options>();
  std::shared_ptr<FileOptions> files = std::make_shared<FileOptions>();

  Subcommand(CLI::App& parent, const char* name, const char* help, int (*work)(const Options&),
             Command& chosen)
      : app(parent.add_subcommand(name, help)) {
    app->add_option("--threads", options->threads, "Threads; 0 for one per processor")
        ->check(from_to(0, 1024));
    app->add_flag("--quiet", options->quiet, "Print nothing but errors");
    app->add_option("--json", options->json, "Write figures as JSON to a file, or - for stdout");
    writes("--json", options->json);
    app->callback([&chosen, work, given = options, named = files] {
      chosen = [=] { return named->check(), work(*given); };
    });
  }
  void writes(const char* name, const std::string& path, bool replaces_folder = false) const {
    files->writes.push_back({name, &path, replaces_folder});
  }
  template <class Paths>  // std::string or std::vector<std::string>
  void reads(const char* name, const Paths& paths) const {
    files->reads.push_back({name, &paths});
  }
  /// Adds the options that change a scene without editing its file.
  void add_changes() {
    app->add_option("--preset", options->load.preset,
                    "Accuracy, from the fastest to the most accurate: draft | realtime | accurate "
                    "| reference")
        ->capture_default_str();
    add_set();
  }
  /// Sets Options::preset_given if the command line has --preset.
  void note_preset() {
    app->get_option("--preset")->each([given = options](const std::string&) {
      given->preset_given = true;
    });
  }
  void add_set() {
    app->add_option("--set", options->load.set,
                    "Set a key of the scene, key=value; may be repeated")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
  }
  void add_frames() {
    app->add_option("--frames", options->frames, "Stop after this many frames of 1/60 s")
        ->check(from_to(1, kMaxFrames));
  }
};

}  // namespace sunder::app
