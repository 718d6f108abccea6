// The files of a golden, and the result of a comparison.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "render/image/compare.h"
#include "render/sinks.h"
#include "scenes/timing/frame_states.h"
#include "scenes/timing/verdict.h"

namespace sunder::app {

/// NAME.json: the sources of the frame and of the baseline, and the allowed difference of a
/// picture.
struct Golden {
  std::filesystem::path folder;
  std::string name;
  /// File (relative to the folder) or name of a scene, or stored frame of another golden.
  std::string scene;
  scenes::LoadOptions load;
  /// Index of the frame in the scene's run, or of the picture of a film of another speed.
  int frame = 0;
  double speed = 1;  ///< Seconds of the run per second of the film.
  int width = 640;
  int height = 360;
  std::string view_mode = "materials";  ///< A view mode that needs an Inspection stores one.
  bool hud = false;
  int samples = 1;
  bool transparent = false;
  std::string layer;  ///< Data layer that is the picture, in colours; empty: the image itself.
  bool to_the_end = false;  ///< True if the states of each second of the whole run are stored.
  /// False for a golden of a scene that is drawn from the simulation; it has NAME.view.
  bool has_frame = true;
  render::Thresholds thresholds;
  std::string hash;      ///< Hash of the baseline's pixels.
  std::string renderer;  ///< Renderer that drew the baseline.
  std::string cpu;       ///< Processor on which the baseline was drawn.
  /// Hash of the original picture's pixels, of NAME.original.png; empty: it is the baseline. The
  /// original is the picture that was accepted first, or last by `golden accept --rebase`.
  std::string original;
  std::string rebased;  ///< Reason given by the last --rebase; empty: there was none.

  std::filesystem::path file(const char* extension) const { return folder / (name + extension); }
  std::filesystem::path picture_file() const { return file(".png"); }
  std::filesystem::path original_file() const { return file(".original.png"); }
  std::filesystem::path hashes_file() const { return folder / "hashes.txt"; }
  /// Returns true for a golden of a scene, false for one of the stored frame of another golden.
  bool is_simulated() const { return !scene.ends_with(".frame"); }
  /// Returns the path of the file `scene` if there is one, otherwise `scene` itself, a name.
  std::string scene_file() const;
  /// Returns the file of the stored frame, or of the frame without geometry if none is stored.
  std::filesystem::path frame_file() const;
  /// Returns the run whose states are compared with the stored ones.
  scenes::GuardedRun run() const {
    return {name, scene_file(), load, last_source_frame(), !has_frame, to_the_end};
  }
  /// Returns the last frame of the run that the picture is drawn from; `frame`, unless it is
  /// between two frames.
  int last_source_frame() const;
  /// Returns true if the picture depends on more than one frame, by `speed` or motion blur.
  bool is_film() const { return speed != 1 || (samples > 1 && !has_frame); }
  /// Returns the shell commands that make the golden again.
  std::string command() const;
  std::string accept_command(bool rebases = false) const;
};

/// Returns the command that makes the current pictures and states of goldens their baselines.
/// `rebases`: with --rebase, because a picture is too far from its original.
std::string accept_command(const std::filesystem::path& folder, const std::string& names,
                           bool rebases = false);

/// The original picture of a golden.
struct Original {
  std::optional<render::Image> picture;  ///< Nothing if no picture was accepted yet.
  /// States what is wrong if the file is missing or has another picture than the accepted one.
  std::string fault;
};
Original read_original(const Golden& golden);

/// Returns the names of the goldens in a folder, sorted. Throws InputError if there are none.
std::vector<std::string> golden_names(const std::filesystem::path& folder);
/// Reads a golden. Throws InputError that lists the goldens if there is none of this name.
Golden read_golden(const std::filesystem::path& folder, const std::string& name);
void write_golden(const Golden& golden);

struct GoldenResult {
  Golden golden;
  render::Image baseline;
  render::Image actual;
  render::Difference difference;
  Original original;
  render::Difference from_original;  ///< Difference of `actual` from the original.
  std::string renderer;
  /// Verdict on the drawing; for a golden of a scene, then on its view and on each simulation.
  std::vector<scenes::Verdict> verdicts;

  bool drawing_passed() const;
  /// Returns how far the picture is from the original, 1 being the farthest that is accepted; 0 if
  /// there is no original.
  double share_of_original() const {
    return original.picture ? from_original.share_of(golden.thresholds) : 0;
  }
  /// Returns true if the picture is accepted only by --rebase.
  bool must_rebase() const {
    return !original.fault.empty() ||
           (original.picture && !from_original.passes(golden.thresholds));
  }
  bool passed() const;
  /// Returns the results of drawing and simulation, and the texts of failed verdicts.
  std::string sentence() const;
};
/// Returns the goldens whose pictures are not equal to the originals, the farthest first.
std::vector<const GoldenResult*> by_distance_from_original(
    const std::vector<GoldenResult>& results);
/// Returns the results as JSON.
std::string format_results(const std::vector<GoldenResult>& results);

/// Returns the differences in appearance between a scene and a frame that was stored of it, as a
/// list of names: keys of the view, colours of materials, appearances from files, materials of
/// solids; empty if there are none.
std::string view_differences(const Frame& stored, const Scene& scene);
/// Returns a hash of size and pixels as 16 hexadecimal digits.
std::string pixel_hash(const render::Image& image);
/// Returns what view_differences() needs of a frame, for a smaller file.
Frame without_geometry(const Frame& frame);

}  // namespace sunder::app
