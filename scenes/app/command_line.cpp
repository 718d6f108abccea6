// Declares the options of every command. Read first: parse_command_line().
#include "scenes/app/command_line.h"

#include <span>

#include "render/camera.h"
#include "render/passes/layers.h"
#include "render/view_mode.h"
#include "scenes/app/arguments.h"
#include "scenes/app/build_info.h"
#include "scenes/app/commands.h"
#include "scenes/app/manual.h"
#include "scenes/app/subcommand.h"
#include "scenes/solid_break.h"
#include "scenes/trade/study.h"

namespace sunder::app {
namespace {

void add_list(CLI::App& program, Command& chosen) {
  Subcommand<ListOptions> command(program, "list", "The scenes, one line each", list, chosen);
  command.app->add_flag("--keys", command.options->keys,
                        "Every key of a scene file instead, as Markdown");
  command.app->get_option("--quiet")->description("Print the names alone");
}

void add_check(CLI::App& program, Command& chosen) {
  Subcommand<CheckOptions> command(program, "check",
                                   "Load and validate scenes, without running them", check, chosen);
  command.app->add_option("SCENE", command.options->scenes, "Files or names of scenes")->required();
  command.reads("SCENE", command.options->scenes);
  command.add_changes();
}

void add_simulate(CLI::App& program, Command& chosen) {
  Subcommand<SimulateOptions> command(program, "simulate", "Run a scene without pictures", simulate,
                                      chosen);
  CLI::Option* const scene =
      command.app->add_option("SCENE", command.options->scene, "File or name of a scene");
  command.app
      ->add_option("--save-at", command.options->save_at,
                   "Save the state at this time of the scene, in s, to a file")
      ->type_name("TIME FILE");
  CLI::Option* const resume = command.app->add_option(
      "--resume", command.options->resume, "Go on from a saved state, in place of a scene");
  command.app->add_option("--take", command.options->take, "Record the run to this file");
  CLI::Option* const verify = command.app->add_option(
      "--verify", command.options->verify,
      "A recording of the same run; stop and fail at the first frame whose state differs");
  command.app
      ->add_flag("--keep-going", command.options->keep_going,
                 "With --verify: go on to the end of the run, and count the frames that differ")
      ->needs(verify);
  CLI::Option* events = command.app->add_option(
      "--events", command.options->events,
      "Write breaks, and bodies that appear, disappear, sleep and wake, as a line of JSON each");
  command.app
      ->add_option("--hits", command.options->hits_m_s,
                   "Write hits of at least this closing speed in m/s, too")
      ->needs(events)
      ->check(CLI::NonNegativeNumber);
  command.app->add_option("--trace", command.options->trace,
                          "Write a trace of all threads, for ui.perfetto.dev");
  command.app->add_flag("--count-threads", command.options->count_threads,
                        "Run on one thread, and report what 2 to 16 threads would take");
  CLI::Option* const draw =
      command.app
          ->add_option("--draw", command.options->draw,
                       "Draw one of every N frames, of 640x360 pixels, and report its time")
          ->type_name("N")
          ->check(from_to(1, kMaxFrames));
  CLI::Option* const without =
      command.app
          ->add_option("--without", command.options->without,
                       "Leave out a feature that the JSON names as modelled, such as dust")
          ->type_name("FEATURE");
  command.reads("SCENE", command.options->scene);
  command.reads("--verify", command.options->verify);
  command.writes("--take", command.options->take);
  command.writes("--events", command.options->events);
  command.writes("--trace", command.options->trace);
  command.writes("--save-at", command.options->save_at.second);
  command.reads("--resume", command.options->resume);
  command.add_frames();
  command.add_changes();
  for (CLI::Option* const option : {scene, draw, without, command.app->get_option("--preset"),
                                    command.app->get_option("--set")})
    resume->excludes(option);
}

/// Adds the options of how a frame is drawn.
void add_looks(CLI::App* app, render::RenderOptions& options) {
  app->add_flag("--hud", options.hud, "Frame number, time and counts in the corner");
  app->add_option("--view-mode", options.view_mode,
                  std::string("How pieces are shown: ") + render::kViewModes)
      ->capture_default_str();
  app->add_option("--samples", options.samples,
                  "Samples per image: antialiasing, and motion blur by view.shutter")
      ->check(from_to(1, 1024))
      ->capture_default_str();
  app->add_flag("--transparent", options.transparent,
                "Images with a transparent background instead of ground and sky");
}

void add_speed(CLI::App* app, double& speed) {
  app->add_option("--speed", speed,
                  "Speed of the video; 0.1 is ten times slower, with interpolated frames")
      ->check(from_to(0.001, 1000.0))
      ->capture_default_str();
}

void add_render(CLI::App& program, Command& chosen) {
  Subcommand<RenderOptions> command(program, "render", "Off-screen video or images of a scene",
                                    render_scene, chosen);
  RenderOptions& options = *command.options;
  command.app
      ->add_option("SCENE", options.scene, "File or name of a scene, a .take or a .frame file")
      ->required();
  command.app
      ->add_option("-o,--output", options.output,
                   "X.mp4, X.webm: video; X.png: the last frame; DIR/: a PNG per frame")
      ->required();
  command.app
      ->add_option("--frames", options.frames,
                   "Draw frames A to B, both included; A: to the end, :B from the start, A alone")
      ->type_name("A:B");
  command.app
      ->add_option("--view", options.view,
                   std::string("Camera: ") + render::kCameras + " | FILE.toml, a camera path")
      ->type_name("SPEC")
      ->capture_default_str();
  add_speed(command.app, options.speed);
  command.app->add_option("--fps", options.render.frames_per_s, "Images per second of the video")
      ->check(from_to(1, 1000))
      ->capture_default_str();
  command.app
      ->add_option(
          "--sheet", options.sheet,
          "Contact sheet: that many images of the run, at even intervals and with times, in X.png")
      ->type_name("N")
      ->check(from_to(1, 1000));
  command.app->add_flag("--resume", options.resume,
                        "Keep the images that DIR/ has, and draw the missing ones");
  command.app
      ->add_option("--size", options.size,
                   "Pixels; by default 1280x720, and 480x270 for images of a sheet")
      ->type_name("WxH");
  command.app
      ->add_option("--also", options.render.layers,
                   std::string("Additional images, of 16 bits, depth_m of 32-bit floats: ") +
                       render::kLayers)
      ->type_name("NAME,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  command.app
      ->add_option("--gl", options.render.gl, "auto | egl-device:N | egl-surfaceless | osmesa")
      ->capture_default_str();
  command.reads("SCENE", options.scene);
  command.reads("--view", options.view);
  command.writes("-o", options.output);
  add_looks(command.app, options.render);
  command.add_changes();
  command.note_preset();
}

void add_export(CLI::App& program, Command& chosen) {
  Subcommand<ExportOptions> command(program, "export", "A run as files for other programs",
                                    export_scene, chosen);
  ExportOptions& options = *command.options;
  command.app->add_option("SCENE", options.scene, "File or name of a scene, or a .take file")
      ->required();
  command.app
      ->add_option("-o,--output", options.output,
                   "X.glb: animated glTF; DIR/: a mesh file per frame")
      ->required();
  command.app
      ->add_option("--tolerance", options.tolerance_m,
                   "glTF: distance by which a body may be from its place in any frame; 0.001 by "
                   "default")
      ->type_name("METRES")
      ->check(from_to(1e-5, 10.0));
  command.app
      ->add_option("--angle", options.tolerance_deg,
                   "glTF: angle by which a body may be turned in any frame; 0.1 by default")
      ->type_name("DEGREES")
      ->check(from_to(0.01, 45.0));
  command.app->add_flag("--particles", options.particles,
                        "glTF: write debris as well, by EXT_mesh_gpu_instancing");
  command.app->add_option("--format", options.format, "Mesh files in DIR/: obj, by default, or ply")
      ->type_name("NAME");
  command.app->add_option("--fps", options.frames_per_s, "Frames per second; a divisor of 60")
      ->check(from_to(1, 60))
      ->capture_default_str();
  command.reads("SCENE", options.scene);
  command.writes("-o", options.output, true);
  command.add_frames();
  command.add_changes();
  command.note_preset();
}

void add_view(CLI::App& program, Command& chosen) {
  Subcommand<ViewOptions> command(program, "view", "A page that plays a run in a browser", view,
                                  chosen);
  ViewOptions& options = *command.options;
  command.app
      ->add_option("SCENE", options.scene, "File or name of a scene, a .take file, or a .glb file")
      ->required();
  command.app->add_option("-o,--output", options.output, "X.html: the page")->required();
  command.app
      ->add_option("--three", options.three,
                   "Folder of three.js r111, by default that of the Debian package libjs-three")
      ->type_name("DIR")
      ->capture_default_str();
  command.reads("SCENE", options.scene);
  command.writes("-o", options.output);
  command.add_frames();
  command.add_changes();
  command.note_preset();
}

void add_bench(CLI::App& program, Command& chosen) {
  Subcommand<BenchOptions> command(program, "bench", "Frame timing of the benchmark scenes", bench,
                                   chosen);
  BenchOptions& options = *command.options;
  auto* scenes = command.app->add_option("SCENE", options.scenes, "Files or names of scenes")
                     ->capture_default_str();
  command.app
      ->add_option("--repeats", options.repeats,
                   "Runs of each scene, in turns; 5 by default, and 15 with --against")
      ->check(from_to(1, 1000));
  command.app->add_option("--warm-up", options.warm_up, "Turns before the first that counts")
      ->check(from_to(0, 1000))
      ->capture_default_str();
  auto* draw = command.app
                   ->add_option("--draw", options.draw,
                                "Draw one of every N frames, of 640x360 pixels, and time it, too")
                   ->type_name("N")
                   ->check(from_to(1, kMaxFrames));
  auto* features = command.app->add_flag("--features", options.features,
                                         "Also run each scene without each feature it has");
  auto* compare = command.app->add_option(
      "--compare", options.compare,
      "Show the changes from an earlier --json file, also of simulate; fail if a state differs, a "
      "scene is missing in it, or times cannot be compared");
  auto* against = command.app
                      ->add_option("--against", options.against,
                                   "Compare with another sunder program, timed at the same time")
                      ->type_name("PROGRAM")
                      ->excludes(compare);
  command.app
      ->add_option(
          "--fail-slower", options.fail_slower,
          "With --against: fail if a figure is certainly slower by more than this; p99 may "
          "be by 2 times, max by 4 times this, or as given: 5%,max=50%,memory=2%")
      ->type_name("PERCENT[,FIGURE=PERCENT...]");
  auto* accept = command.app->add_flag("--accept", options.accept,
                                       "Store the states of this run as the expected ones");
  command.app->add_option("--hashes", options.hashes, "File of stored states")
      ->capture_default_str();
  command.app
      ->add_option("--from", options.from,
                   "Report on an earlier --json file without running scenes")
      ->excludes(scenes)
      ->excludes(against)
      ->excludes(features)
      ->excludes(draw)
      ->excludes(accept);
  command.app->add_option("--junit", options.junit, "Write passed and failed tests as JUnit XML");
  command.app->add_option("--page", options.page,
                          "Write an HTML page with every stage of every frame plotted");
  command.reads("SCENE", options.scenes);
  command.reads("--compare", options.compare);
  command.reads("--against", options.against);
  command.reads("--from", options.from);
  command.reads("--hashes", options.hashes);
  command.writes("--junit", options.junit);
  command.writes("--page", options.page);
  command.add_frames();
  command.add_changes();
}

void add_trade(CLI::App& program, Command& chosen) {
  Subcommand<TradeOptions> command(
      program, "trade", "Cost of accuracy: runs scenes with settings from coarse to fine", trade,
      chosen);
  TradeOptions& options = *command.options;
  command.app->add_option("SCENE", options.scenes, "Files or names of scenes")->required();
  command.app->add_option("-o,--output", options.output, "Folder of results and reports")
      ->type_name("DIR");
  command.app
      ->add_option("--points", options.points,
                   "File of points, NAME PRESET KEY=VALUE... on each line; a grid of 12 by default")
      ->type_name("FILE");
  command.app
      ->add_option("--switch", options.switches,
                   "Run every preset also with this key of the scene set; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command.app->add_option("--seeds", options.seeds, "Runs of each scene at each point")
      ->check(from_to(1, scenes::kMaxSeeds))
      ->capture_default_str();
  auto* equal =
      command.app
          ->add_option(
              "--equal", options.equal,
              "Compare N pairs of groups of equal runs, of realtime or of each of --points")
          ->type_name("N")
          ->check(from_to(1, 100000));
  command.app
      ->add_option("--pool", options.pool,
                   "Runs that --equal draws groups of --seeds from; 4 times --seeds by default")
      ->type_name("N")
      ->check(from_to(4, scenes::kMaxSeeds))
      ->needs(equal);
  command.app->add_flag("--list", options.list, "Print the runs, one per line, without doing them");
  auto* shard =
      command.app
          ->add_option("--shard", options.shard, "Do share I of N of the runs, and make no reports")
          ->type_name("I/N");
  command.app->add_flag("--merge", options.merge, "Make the reports of the finished runs")
      ->excludes(shard);
  command.reads("SCENE", options.scenes);
  command.reads("--points", options.points);
  command.add_frames();
  command.add_set();
}

constexpr const char* kMeshHelp =
    "A file (.obj .ply .stl .off .gltf .glb), a built-in solid (box:X,Y,Z column:R,H torus:R,r "
    "grid:NX,NY,NZ voronoi:N hall:N), or the built-in mesh statue:N, of N triangles";

/// Adds the options of the decomposition of a mesh.
void add_scale(CLI::App* app, double& scale) {
  app->add_option("--scale", scale, "Length of one unit of a file, in m")
      ->check(from_to(1e-6, 1e6))
      ->capture_default_str();
}

void add_decomposition(CLI::App* app, scenes::MeshOptions& options) {
  add_scale(app, options.scale);
  app->add_option(
         "--nodes", options.nodes,
         "Nodes of the decomposition of a file: their number, or a file with x y z on each line")
      ->type_name("N|FILE");
  app->add_option("--convexes", options.convexes, "Maximum number of convexes")
      ->check(from_to(1u, fracture::kMostNodes));
  app->add_option("--fit", options.fit,
                  "Shape that encloses each convex: aabb | 14dop | 26dop | hull:N")
      ->capture_default_str();
  app->add_option("--repair", options.repair,
                  "auto: repair the mesh and list the repairs; off: fail if the mesh needs repair")
      ->capture_default_str();
}

/// Adds the options of the output of a command on a mesh, and declares its input files.
template <class Options>
void add_solids_output(Subcommand<Options>& command) {
  CLI::App* app = command.app;
  Options& options = *command.options;
  command.reads("MESH", options.mesh);
  command.reads("--nodes", options.solid.nodes);
  command.writes("-o", options.output, true);
  app->add_option("-o,--output", options.output,
                  "X.glb: glTF, one node per piece; X.png: an image; DIR/: one .obj per piece");
  app->add_option("--explode", options.explode,
                  "Move the pieces of -o apart by this times their distance from the middle; by "
                  "default 0.3 for an image, else 0")
      ->check(from_to(0.0, 1000.0));
}

void add_fracture(CLI::App& program, Command& chosen) {
  Subcommand<FractureOptions> command(program, "fracture",
                                      "Breaks one solid once, and measures every invariant",
                                      fracture_mesh, chosen);
  FractureOptions& options = *command.options;
  command.app
      ->add_option("MESH", options.mesh, std::string(kMeshHelp) + "; or X.case, a file of a break")
      ->required();
  command.app->add_option("--pattern", options.pattern, scenes::kPatternHelp)->type_name("SPEC");
  command.app
      ->add_option("--at", options.at,
                   "Position of the impact; the middle of the bounding box by default")
      ->type_name("X,Y,Z");
  command.app
      ->add_option("--radius", options.radius_m,
                   "Radius around the impact within which the solid breaks; unlimited by default")
      ->type_name("METRES")
      ->check(from_to(1e-9, 1e9));
  command.app->add_option("--seed", options.seed, "Seed of the pattern")
      ->check(from_to<std::uint64_t>(0, std::numeric_limits<std::int64_t>::max()))
      ->capture_default_str();
  command.app
      ->add_option("--walls", options.walls,
                   "Faces between convexes of one piece in -o: remove leaves the outer surface of "
                   "each piece; keep writes each convex closed")
      ->check(CLI::IsMember({"remove", "keep"}))
      ->capture_default_str();
  command.reads("--pattern", options.pattern);
  add_decomposition(command.app, options.solid);
  add_solids_output(command);
}

void add_vacd(CLI::App& program, Command& chosen) {
  Subcommand<VacdOptions> command(program, "vacd", "Approximate convex decomposition of a mesh",
                                  vacd, chosen);
  VacdOptions& options = *command.options;
  command.app
      ->add_option("MESH", options.mesh,
                   "A file (.obj .ply .stl .off .gltf .glb), or statue:N, of N triangles")
      ->required();
  add_decomposition(command.app, options.solid);
  command.app->add_flag(
      "--watch", options.watch,
      "Repeat, and redraw -o, whenever the file of --nodes changes, until stopped");
  add_solids_output(command);
  command.app->add_option("--hulls", options.hulls,
                          "Write the collision hulls alone: X.glb, with nodes that engines take "
                          "for such (UCX_..., ...-convcolonly), or X.obj, with an object per hull");
}

void add_hull(CLI::App& program, Command& chosen) {
  Subcommand<HullOptions> command(program, "hull", "Approximate convex hull of a mesh", hull,
                                  chosen);
  command.app->add_option("MESH", command.options->mesh, kMeshHelp)->required();
  command.reads("MESH", command.options->mesh);
  command.app
      ->add_option("--vertices", command.options->vertices,
                   "Number of vertices that the hull is made from")
      ->required()
      ->check(from_to(4, 10000));
  add_scale(command.app, command.options->scale);
}

void add_doctor(CLI::App& program, Command& chosen) {
  Subcommand<DoctorOptions>(program, "doctor",
                            "What the program finds on this machine, and what is missing", doctor,
                            chosen);
}

/// Adds a command that the help does not list: the build of the project runs it.
void add_manual(CLI::App& program, Command& chosen) {
  CLI::App* app = program.add_subcommand("manual", "Write manual pages and shell completions");
  app->group("");
  app->add_option_function<std::string>("DIR",
                                        [&program, &chosen](const std::string& folder) {
                                          chosen = [folder, files = manual_files(program)] {
                                            return write_manual(folder, files);
                                          };
                                        })
      ->required();
}

Subcommand<GoldenOptions> add_golden(CLI::App& golden, Command& chosen, const char* name,
                                     const char* help, int (*work)(const GoldenOptions&),
                                     const std::string& folder) {
  Subcommand<GoldenOptions> command(golden, name, help, work, chosen);
  command.options->folder = folder;
  command.app->add_option("--folder", command.options->folder, "Folder of goldens")
      ->capture_default_str();
  command.app->add_option("--gl", command.options->gl, "As in sunder render")
      ->capture_default_str();
  return command;
}

void add_golden(CLI::App& program, Command& chosen) {
  CLI::App* golden = program.add_subcommand("golden", "Regression tests of drawing and simulation");
  golden->require_subcommand(1);
  const auto add = [&](const char* name, const char* help, int (*work)(const GoldenOptions&),
                       const std::string& folder = goldens_folder()) {
    return add_golden(*golden, chosen, name, help, work, folder);
  };
  for (auto& command :
       {add("test", "Draw the frames, simulate their scenes, and compare both with what is stored",
            golden_test),
        add("report", "As test, and write report.html with all pictures", golden_report)}) {
    command.app->add_option("NAME", command.options->names, "Goldens; all by default");
    command.app->add_flag("--full", command.options->full,
                          "Also simulate whole scenes whose states sunder bench has stored");
    command.app->add_option("--junit", command.options->junit,
                            "Write passed and failed tests as JUnit XML");
    command.writes("--junit", command.options->junit);
    command.app->add_option("--out", command.options->out, "Folder of new files")
        ->capture_default_str();
  }
  const auto accept = add("accept", "Store the current images and states as the expected ones",
                          golden_accept, own_goldens_folder());
  accept.app->add_option("NAME", accept.options->names, "Goldens")->required();
  accept.app
      ->add_option("--rebase", accept.options->rebase,
                   "Accept pictures however far they are from the originals, and store the reason")
      ->type_name("REASON")
      ->check([](const std::string& reason) {
        return reason.find_first_not_of(" \t\n") == std::string::npos
                   ? "give the reason why the pictures change"
                   : "";
      });
  auto record = add("record", "Store a frame of a scene as a golden's subject", golden_record,
                    own_goldens_folder());
  record.app
      ->add_option_function<std::string>(
          "NAME", [given = record.options](const std::string& name) { given->names = {name}; },
          "Name of the golden")
      ->required();
  record.app
      ->add_option("SCENE", record.options->scene,
                   "File or name of a scene, or X.frame: a golden that draws the frame of another")
      ->required();
  record.app->add_option("FRAME", record.options->frame, "Index of the frame in the scene")
      ->check(from_to(0, kMaxFrames));
  record.app->add_flag("--no-frame", record.options->no_frame,
                       "Store no geometry; draw the picture from the simulation");
  record.app->add_option("--size", record.options->size, "Pixels")
      ->type_name("WxH")
      ->capture_default_str();
  add_looks(record.app, record.options->render);
  record.app
      ->add_option("--layer", record.options->layer,
                   std::string("Draw a data layer in place of the image: ") + render::kLayers)
      ->type_name("NAME");
  add_speed(record.app, record.options->speed);
  record.app->add_flag("--to-the-end", record.options->to_the_end,
                       "Also store the states of each second to the end of the scene");
  record.add_changes();
}

}  // namespace

Command parse_command_line(int argc, char** argv) {
  CLI::App program("Simulates and renders destruction.", "sunder");
  program.set_version_flag("--version", version_line());
  program.require_subcommand(1);
  Command chosen;
  add_list(program, chosen);
  add_check(program, chosen);
  add_simulate(program, chosen);
  add_render(program, chosen);
  add_export(program, chosen);
  add_view(program, chosen);
  add_bench(program, chosen);
  add_trade(program, chosen);
  add_fracture(program, chosen);
  add_vacd(program, chosen);
  add_hull(program, chosen);
  add_golden(program, chosen);
  add_doctor(program, chosen);
  add_manual(program, chosen);
  check_words(program, std::span(argv, static_cast<std::size_t>(argc)).subspan(1));
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return [code = program.exit(error) == 0 ? 0 : 2] { return code; };
  }
  return chosen;
}

}  // namespace sunder::app
