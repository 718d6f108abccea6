// The commands of the program and their options. command_line.cpp parses the options.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/renderer.h"
#include "scenes/file/mesh_solid.h"
#include "scenes/load.h"
#include "scenes/report/view_page.h"
#include "scenes/timing/timing.h"

namespace sunder::app {

/// The options of every command.
struct CommonOptions {
  int threads = 0;
  bool quiet = false;
  std::string json;

  /// Sets the threads of the whole program.
  void apply() const;
  /// Prints text for the user on stdout, unless --quiet is given or JSON is written there.
  void print(const std::string& text) const;
  /// Writes JSON to the file of --json, under a temporary name first, or to stdout for "-"; does
  /// nothing without --json. Throws FileError.
  void write_json(const std::string& text) const;
};

/// Returns the folder of the goldens to compare with: tests/golden in the working directory if
/// there are goldens, or else that of the goldens that are installed with the program, if there are
/// any.
std::string goldens_folder();
/// Returns the folder in which goldens are recorded and accepted, tests/golden in the working
/// directory: installed goldens belong to the package.
std::string own_goldens_folder();
/// Returns the folder in which the goldens are when the program is installed.
std::string installed_goldens_folder();
/// Returns the file of the stored state hashes to compare with: hashes.txt in own_goldens_folder()
/// if there is one, or else in goldens_folder().
std::string hashes_file();
/// Returns the absolute path of a folder of goldens or a file of hashes, to be printed, and why it
/// is the installed one, if it is.
std::string place_text(const std::string& place);

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
  int frames = -1;          ///< Index of the last frame; -1: to the end of the scene.
  std::string take;         ///< File to record to; empty: none.
  std::string verify;       ///< Recording to compare with; empty: none.
  bool keep_going = false;  ///< True to go on after the first frame that differs from it.
  std::string events;       ///< File for a line of JSON for each event; empty: none.
  /// Least closing speed of the hits among the events; infinity: none are.
  double hits_m_s = std::numeric_limits<double>::infinity();
  std::string trace;                       ///< File for spans of all threads; empty: none.
  bool count_threads = false;              ///< Report what more threads would take.
  int draw = 0;                            ///< Draw one of this many frames, and time it; 0: none.
  std::string without;                     ///< Feature that is turned off; empty: none.
  std::pair<double, std::string> save_at;  ///< Time in s, and file for the state; empty: none.
  std::string resume;  ///< File of a saved state to go on from, in place of a scene; empty: none.
};

struct RenderOptions : CommonOptions {
  std::string scene;  ///< File or name of a scene, or file of a stored frame or recording.
  scenes::LoadOptions load;
  bool preset_given = false;
  std::string output;
  std::string frames;          ///< "A:B", first and last frame; empty: all.
  std::string view = "fixed";  ///< A camera of render/camera.h, or the file of a camera path.
  double speed = 1;
  int sheet = 0;     ///< Number of pictures of a contact sheet; 0: none.
  std::string size;  ///< "WIDTHxHEIGHT"; empty: the default.
  bool resume = false;
  render::RenderOptions render;
};

struct ExportOptions : CommonOptions {
  std::string scene;  ///< File or name of a scene, or file of a recording.
  scenes::LoadOptions load;
  bool preset_given = false;
  std::string output;
  int frames = -1;                      ///< Index of the last frame; -1: to the end.
  std::optional<double> tolerance_m;    ///< Largest error of an interpolated position.
  std::optional<double> tolerance_deg;  ///< Largest error of an interpolated rotation.
  std::string format;                   ///< "obj" or "ply" for a folder; empty: obj.
  bool particles = false;               ///< Write debris.
  int frames_per_s = 60;
};

struct ViewOptions : ExportOptions {  ///< `scene` may also be a GLB file.
  std::string three = scenes::kThreeFolder;
};

struct BenchOptions : CommonOptions {
  BenchOptions() { threads = 1; }  ///< Threads that wait for each other would count as time.
  std::vector<std::string> scenes = {"house", "brick_wall", "column_row", "glass"};
  scenes::LoadOptions load;
  int frames = scenes::kStateFrames;  ///< Index of the last frame, if the scene is that long.
  int repeats = 0;                    ///< 0: 5, or kJudgedRepeats with another program.
  int warm_up = 1;                    ///< Turns before the repeats, which are not counted.
  int draw = 0;                       ///< As in SimulateOptions.
  bool features = false;              ///< True to also time scenes without each feature they have.
  std::string from;                   ///< File of timings to report on; empty: run the scenes.
  std::string compare;                ///< File of older timings; empty: none.
  std::string against;                ///< Another program to time in the same turns; empty: none.
  std::string fail_slower;            ///< As parse_bounds() reads it; empty: never.
  std::string hashes = hashes_file();
  bool accept = false;
  std::string junit;  ///< File of JUnit XML to write; empty: none.
  std::string page;   ///< HTML file to write; empty: none.
};

struct TradeOptions : CommonOptions {
  TradeOptions() { threads = 1; }  ///< As in BenchOptions; shards use the other processors.
  std::vector<std::string> scenes;
  scenes::LoadOptions load;  ///< Only `set` is used; each point has a preset.
  std::string output;
  std::string points;  ///< File of points; empty: the default grid.
  std::vector<std::string> switches;
  int seeds = 8;
  int equal = 0;      ///< Pairs of groups of equal runs to compare, in place of points; 0: none.
  int pool = 0;       ///< Runs that the groups are drawn from; 0: four times the seeds.
  int frames = -1;    ///< Index of the last frame; -1: to the end of the scene.
  std::string shard;  ///< "I/N"; empty: all runs.
  bool list = false;
  bool merge = false;
};

struct DoctorOptions : CommonOptions {};

struct FractureOptions : CommonOptions {
  std::string mesh;  ///< Mesh to break, or a case file with a compound and its break.
  scenes::MeshOptions solid;
  std::string pattern;
  std::string at;                  ///< Impact "x,y,z"; empty: the middle of the bounding box.
  std::optional<double> radius_m;  ///< Radius of the impact sphere; none: everything breaks.
  std::uint64_t seed = 1;
  std::string output;
  std::string walls = "remove";   ///< "remove" or "keep" faces between convexes of a piece.
  std::optional<double> explode;  ///< Distance factor of pieces; none: the default of the output.
};

struct VacdOptions : CommonOptions {
  std::string mesh;
  scenes::MeshOptions solid;
  bool watch = false;
  std::string output;
  std::string hulls;              ///< File for the collision hulls; empty: none.
  std::optional<double> explode;  ///< Distance factor of pieces; none: the default of the output.
};

struct HullOptions : CommonOptions {
  std::string mesh;
  std::uint32_t vertices = 0;
  double scale = 1;  ///< Length of one unit of a file, in m.
};

struct GoldenOptions : CommonOptions {
  std::vector<std::string> names;  ///< Goldens; empty: all.
  std::string folder = goldens_folder();
  std::string out = "out/golden";
  std::string gl = "auto";
  bool full = false;   ///< True to also simulate whole scenes.
  std::string junit;   ///< File of JUnit XML to write; empty: none.
  std::string rebase;  ///< Reason to accept pictures far from their originals; empty: do not.
  // Options of golden_record() alone.
  std::string scene;  ///< File or name of a scene, or file of a stored frame.
  scenes::LoadOptions load;
  int frame = -1;
  double speed = 1;
  std::string layer;
  bool no_frame = false;  ///< True to draw the picture from the simulation.
  bool to_the_end = false;
  std::string size = "640x360";
  render::RenderOptions render;
};

/// The commands return the exit code, 0 for success or 1, and throw InputError for wrong input.
int list(const ListOptions& options);
int check(const CheckOptions& options);
int simulate(const SimulateOptions& options);
int render_scene(const RenderOptions& options);
int export_scene(const ExportOptions& options);
int view(const ViewOptions& options);
int bench(const BenchOptions& options);
int trade(const TradeOptions& options);
int fracture_mesh(const FractureOptions& options);
int vacd(const VacdOptions& options);
int hull(const HullOptions& options);
int doctor(const DoctorOptions& options);
int golden_test(const GoldenOptions& options);
int golden_report(const GoldenOptions& options);
int golden_accept(const GoldenOptions& options);
int golden_record(const GoldenOptions& options);

}  // namespace sunder::app
