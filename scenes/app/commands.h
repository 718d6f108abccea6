// The commands of the program and what each can be told. How a command line says it is in
// command_line.cpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/timing/timing.h"
#include "render/renderer.h"
#include "scenes/file/mesh_solid.h"
#include "scenes/load.h"

namespace sunder::app {

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

/// Folder of the goldens and of the stored states: that of the source tree if the program runs
/// where it was built, else tests/golden in the working directory. A program that was installed or
/// copied must not change the tree that it was built from.
std::string goldens_folder();

struct ListOptions : CommonOptions {
  bool keys = false;
};

struct CheckOptions : CommonOptions {
  std::vector<std::string> scenes;
  scenes::LoadOptions load;
};

struct SimulateOptions : CommonOptions {
  std::string scene;
  scenes::LoadOptions load;
  int frames = -1;     ///< All.
  std::string take;    ///< File to record to; empty: none.
  std::string verify;  ///< Take to compare with; empty: none.
  std::string trace;   ///< File for spans of all threads; empty: none.
};

struct RenderOptions : CommonOptions {
  std::string scene;  ///< Or a stored frame, or a take.
  scenes::LoadOptions load;
  bool preset_given = false;
  std::string output;
  std::string frames;          ///< "A:B"
  std::string view = "fixed";  ///< As render/camera.h has it, or a file of its path.
  double speed = 1;
  int sheet = 0;     ///< Pictures of a contact sheet; 0: none.
  std::string size;  ///< Empty: what is usual.
  bool resume = false;
  render::RenderOptions render;
};

struct BenchOptions : CommonOptions {
  BenchOptions() { threads = 1; }  ///< Waiting costs time too.
  std::vector<std::string> scenes = {"house", "brick_wall", "column_row", "glass"};
  scenes::LoadOptions load;
  int frames = bench::kStateFrames;  ///< Or to the end of the scene.
  int repeats = 5;
  int warm_up = 1;          ///< Turns before them, not counted.
  bool features = false;    ///< Also without each feature that can be turned off.
  std::string from;         ///< Timings to read; empty: what is run.
  std::string compare;      ///< Older timings; empty: none.
  std::string against;      ///< Another program, timed in the same turns; empty: none.
  std::string fail_slower;  ///< "10%"; empty: never.
  std::string hashes = goldens_folder() + "/hashes.txt";
  bool accept = false;
  std::string junit;  ///< File to write; empty: none, as for:
  std::string page;
};

struct TradeOptions : CommonOptions {
  TradeOptions() { threads = 1; }  ///< Waiting costs time too; shards use the other processors.
  std::vector<std::string> scenes;
  scenes::LoadOptions load;  ///< Of it, `set` alone: points have presets.
  std::string output;
  std::string points;  ///< File; empty: the grid of the program.
  std::vector<std::string> switches;
  int seeds = 8;
  int frames = -1;    ///< All.
  std::string shard;  ///< "I/N"; empty: all runs.
  bool list = false;
  bool merge = false;
};

struct FractureOptions : CommonOptions {
  std::string mesh;  ///< Or a case file, which holds everything else.
  scenes::MeshOptions solid;
  std::string pattern;
  std::string at;                  ///< "x,y,z"; empty: the middle of the bounding box.
  std::optional<double> radius_m;  ///< None: everything breaks.
  std::uint64_t seed = 1;
  std::string output;
  std::string walls = "remove";   ///< Or "keep".
  std::optional<double> explode;  ///< None: a picture shows its pieces apart.
};

struct VacdOptions : CommonOptions {
  std::string mesh;
  scenes::MeshOptions solid;
  bool watch = false;
  std::string output;
  std::optional<double> explode;  ///< None: a picture shows its pieces apart.
};

struct HullOptions : CommonOptions {
  std::string mesh;
  std::uint32_t vertices = 0;
};

struct GoldenOptions : CommonOptions {
  std::vector<std::string> names;  ///< None: all.
  std::string folder = goldens_folder();
  std::string out = "out/golden";
  std::string gl = "auto";
  bool full = false;  ///< Whole simulations, too.
  std::string junit;  ///< File to write; empty: none.
  std::string scene;  ///< Of golden_record, or a stored frame; as are:
  scenes::LoadOptions load;
  int frame = -1;
  std::string size = "640x360";
  render::RenderOptions render;
};

/// Each answers the program's exit code: 0 done, 1 failed; bad input is an InputError.
int list(const ListOptions& options);
int check(const CheckOptions& options);
int simulate(const SimulateOptions& options);
int render_scene(const RenderOptions& options);
int bench(const BenchOptions& options);
int trade(const TradeOptions& options);
int fracture_mesh(const FractureOptions& options);
int vacd(const VacdOptions& options);
int hull(const HullOptions& options);
int golden_test(const GoldenOptions& options);
int golden_report(const GoldenOptions& options);
int golden_accept(const GoldenOptions& options);
int golden_record(const GoldenOptions& options);

/// Writes a text file under a temporary name and renames it. Throws FileError.
void write_text(const std::string& path, const std::string& text);

}  // namespace sunder::app
