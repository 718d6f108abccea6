// Options that commands share, and what they mean.
#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "scenes/load.h"

namespace sunder::app {

/// What a subcommand does once the line is parsed; answers the exit code.
using Command = std::function<int()>;

/// Every command has these.
struct CommonOptions {
  int threads = 0;
  bool quiet = false;
  std::string json;

  /// Sets the threads of the whole program.
  void apply() const;
  /// Text for people: on stdout, unless it is quiet or JSON goes there.
  void say(const std::string& text) const;
  /// To the file (under a temporary name first) or, for "-", to stdout; nothing without --json.
  void write_json(const std::string& text) const;
};
void add_common(CLI::App& command, CommonOptions& options);

/// What commands that run a scene have.
struct SceneOptions {
  std::string scene;
  scenes::LoadOptions load;
};
void add_changes(CLI::App& command, scenes::LoadOptions& load);

/// Writes a text file under a temporary name and renames it. Throws InputError.
void write_text(const std::string& path, const std::string& text);

void add_list(CLI::App& app, Command& chosen);
void add_check(CLI::App& app, Command& chosen);
void add_simulate(CLI::App& app, Command& chosen);
void add_render(CLI::App& app, Command& chosen);
void add_bench(CLI::App& app, Command& chosen);
void add_golden(CLI::App& app, Command& chosen);

}  // namespace sunder::app
