// The tables and keys of a scene file. Defaults are those of the objects that keys are stored in.
#include "scenes/file/schema.h"

namespace sunder::scenes {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Range kPlace{-1e6, 1e6};
constexpr Range kSpeed{-1e4, 1e4};
constexpr Range kRadius{0.001, 100};
constexpr Range kFraction{0, 1};
constexpr Range kLight{0, 100};

constexpr std::string_view kPatterns[] = {"none",  "voronoi", "web",  "radial",
                                          "brick", "slabs",   "grid", "file"};
constexpr std::string_view kTextures[] = {"plain", "brick", "concrete", "plaster",
                                          "wood",  "glass", "metal"};
constexpr std::string_view kBursts[] = {"ground", "air"};
constexpr std::string_view kAnchored[] = {"none", "bottom", "all"};

Keys<Scene> top_keys() {
  return {
      "the scene file",
      {table_key("scene", "What it is."), table_key("accuracy", "Overrides the preset."),
       table_key("solver", "How contacts are solved."), table_key("limits", "How much may exist."),
       table_key("ground", "The floor."), table_key("view", "Camera and sun."),
       table_key("material", "Materials."), table_key("solid", "What stands there."),
       table_key("body", "Meshes that stand there."), table_key("ball", "Balls from the start."),
       table_key("joint", "What holds things together."), table_key("script", "What happens.")}};
}

Keys<Scene> scene_keys() {
  return {"[scene]",
          {key<&Scene::description>("description", "One line for `sunder list`.").must(),
           key<&Scene::duration_s>("duration_s", "s", Range{0.1, 600}, "How long it runs."),
           key<&Scene::seed>("seed", "", Range{0, 9e15}, "Changes every random choice."),
           key<&Scene::gravity_W>("gravity", "m/s²", Range{-100, 100}, "Acceleration of all."),
           key<&Scene::planar>("planar",
                               "Nothing moves along z: all are prisms through the plane z = 0, or "
                               "balls about it.")}};
}

Keys<SolverOptions> solver_keys() {
  return {
      "[solver]",
      {key<&SolverOptions::max_colors>(
           "max_colors", "", Range{0, 64},
           "Colours that contacts are solved in; 64: coloured Gauss-Seidel; contacts that find "
           "no colour are solved by mass splitting; 0: all of them."),
       key<&SolverOptions::sweeps>("sweeps", "", Range{1, 1000},
                                   "Sweeps of either kind in a substep; from 4 on by conjugate "
                                   "gradients. 4 at `reference`."),
       key<&SolverOptions::lanes>("lanes", "", Range{0, 16},
                                  "Contacts side by side: 1, 4, 8 or 16, if the processor has so "
                                  "many; 0: the most. The same bits for any.")}};
}

Keys<Material> material_keys() {
  return {
      "[[material]]",
      {key<&Material::density_kg_m3>("density_kg_m3", "kg/m³", Range{1, 30000}, "Density."),
       key<&Material::friction>("friction", "", Range{0, 10}, "Coefficient of friction."),
       key<&Material::rolling>("rolling", "", Range{0, 1},
                               "Resistance to rolling: its torque, over load and radius."),
       key<&Material::restitution>("restitution", "", kFraction, "0 = no bounce, 1 = full."),
       key<&Material::strength_Ns>("strength_Ns", "N·s", Range{0, kInfinity},
                                   "Obsolete: least impulse of a contact that breaks it, whatever "
                                   "its limits of stress."),
       key<&Material::toughness_J_m2>("toughness_J_m2", "J/m²", Range{0, kInfinity},
                                      "Energy that each square metre of crack takes."),
       key<&Material::tensile_Pa>("tensile_Pa", "Pa", Range{0, kInfinity},
                                  "Tension that breaks a bond, by weight or slow load; 0: never."),
       key<&Material::shear_Pa>("shear_Pa", "Pa", Range{0, kInfinity}, "Shear that does."),
       key<&Material::compressive_Pa>("compressive_Pa", "Pa", Range{0, kInfinity},
                                      "Pressure that does."),
       key<&Material::reinforcement_percent>(
           "reinforcement_percent", "%", Range{0, 10},
           "Steel each way in each face, against being perforated."),
       key<&Material::youngs_Pa>("youngs_Pa", "Pa", Range{1, 1e13},
                                 "Stiffness: how bonds share a load."),
       key<&Material::yield_Pa>("yield_Pa", "Pa", Range{0, kInfinity},
                                "Stress at which it bends in place of breaking; 0: it does not."),
       key<&Material::hardening_Pa>("hardening_Pa", "Pa", Range{0, 1e12},
                                    "By which that grows as it is drawn out to twice its length."),
       key<&Material::elongation>("elongation", "", Range{1e-3, 10},
                                  "By which part of its length it is drawn out when it tears."),
       key<&Material::impact_radius_m>("impact_radius_m", "m", Range{0.001, kInfinity},
                                       "Only what is nearer to the impact breaks; inf: all."),
       key<&Material::smallest_break_m3>(
           "smallest_break_m3", "m³", Range{0, kInfinity},
           "Obsolete: smaller pieces no longer break. Without it, those "
           "below eight of smallest_piece_m3."),
       key<&Material::smallest_piece_m3>("smallest_piece_m3", "m³", Range{0, kInfinity},
                                         "Smaller pieces are debris, no bodies."),
       key<&Material::fit>("fit", "How tightly what collides encloses broken meshes."),
       table_key("pattern", "How it breaks."),
       table_key("stronger", "Patterns of harder impacts."),
       table_key("crumbling", "What comes off where it broke."),
       table_key("surface", "How it looks outside."),
       table_key("interior", "How it looks where it broke.")}};
}

Keys<PatternSpec> pattern_keys() {
  return {
      "[material.pattern]",
      {choice<&PatternSpec::kind>("kind", kPatterns, "none never breaks."),
       key<&PatternSpec::cells>(
           "cells", "", Range{2, 5000},
           "voronoi: sites; radial: sectors; slabs: how many; grid: along each side, at most 30."),
       key<&PatternSpec::falloff>("falloff", "", Range{1, 10},
                                  "voronoi: 1 = uniform, more = smaller near the impact."),
       key<&PatternSpec::rings>("rings", "", Range{1, 100}, "web: rings."),
       key<&PatternSpec::spokes>("spokes", "", Range{3, 200}, "web: spokes."),
       key<&PatternSpec::jitter>("jitter", "", kFraction, "web, radial, slabs: 0 = regular."),
       key<&PatternSpec::brick_m>("brick_m", "m", Range{1e-3, 1000},
                                  "brick: its length, height and depth."),
       key<&PatternSpec::file>("file",
                               "file: an .obj of convex cells, one a group, that fill a box around "
                               "the impact; from the scene's folder on."),
       key<&PatternSpec::colors>(
           "colors", "", Range{0, 5000},
           "Cells are joined into so many pieces, which need not be convex; 0: each is one.")}};
}

Keys<ImpactResponse> stronger_keys() {
  return {
      "[[material.stronger]]",
      {key<&ImpactResponse::energy_J>(
           "energy_J", "J", Range{0, kInfinity},
           "From this on, an impact breaks the material as follows; ascending.")
           .must(),
       key<&ImpactResponse::impact_radius_m>("impact_radius_m", "m", Range{0.001, kInfinity},
                                             "In place of the material's, which is the default."),
       table_key("pattern", "In place of the material's; starts from that.")}};
}

Keys<DebrisEmission> crumbling_keys() {
  constexpr Range kSize{0.0005, 1};
  return {
      "[material.crumbling]",
      {key<&DebrisEmission::particles_per_m2>("particles_per_m2", "1/m²", Range{0, 1e5},
                                              "Debris and dust off new crack surface; 0 for none."),
       key<&DebrisEmission::debris_ratio>("debris_ratio", "", kFraction,
                                          "How many of them are debris; the others are dust."),
       key<&DebrisEmission::debris_smallest_m>("debris_smallest_m", "m", kSize,
                                               "Least radius of debris."),
       key<&DebrisEmission::debris_largest_m>("debris_largest_m", "m", kSize,
                                              "Largest; most is near the least."),
       key<&DebrisEmission::dust_kg_m2>("dust_kg_m2", "kg/m²", Range{0, 100},
                                        "Dust off new crack surface; it weighs on the air."),
       key<&DebrisEmission::dust_settling_m_s>("dust_settling_m_s", "m/s", Range{0, 10},
                                               "How fast dust sinks in still air.")}};
}

Keys<SolidHead> solid_keys() {
  return {
      "[[solid]]",
      {key<&SolidHead::structure>("structure", "Which structure; its keys follow below.").must(),
       key<&SolidHead::name>("name", "Shown in messages; the structure's name by default."),
       key<&SolidHead::velocity>("velocity", "m/s", kSpeed, "At the start."),
       key<&SolidHead::angular_velocity>("angular_velocity", "rad/s", kSpeed, "At the start."),
       choice<&SolidHead::anchored>("anchored", kAnchored,
                                    "bottom: its lowest parts stand on a foundation that the "
                                    "world holds; all: it holds every part, on all sides; none: it "
                                    "is loose.")}};
}

Keys<ShotTable> shot_keys() {
  return {"[[script.shot]]",
          {key<&ShotTable::time_s>("time_s", "s", Range{0, 600}, "When the ball appears.").must(),
           key<&ShotTable::from>("from", "m", kPlace, "Where.").must(),
           key<&ShotTable::velocity>("velocity", "m/s", kSpeed, "How it flies; or give `at`."),
           key<&ShotTable::at>("at", "m", kPlace, "What it is aimed at, in a straight line."),
           key<&ShotTable::speed_m_s>("speed_m_s", "m/s", Range{0, 1e4}, "With `at`: how fast."),
           key<&ShotTable::radius_m>("radius_m", "m", kRadius, "Radius of the ball."),
           key<&ShotTable::material>("material", "What the ball is made of."),
           key<&ShotTable::name>("name", "Shown in messages.")}};
}

constexpr Range kTime{0, 600};

Keys<WreckingBallTable> wrecking_ball_keys() {
  using Given = WreckingBallTable;
  return {"[[script.wrecking_ball]]",
          {key<&Given::time_s>("time_s", "s", kTime, "When the ball appears."),
           key<&Given::from>("from", "m", kPlace, "Where.").must(),
           key<&Given::hangs_from>("hangs_from", "m", kPlace,
                                   "Where its chain is fixed; as long as the way there.")
               .must(),
           key<&Given::velocity>("velocity", "m/s", kSpeed, "At the start."),
           key<&Given::radius_m>("radius_m", "m", kRadius, "Radius of the ball."),
           key<&Given::links>("links", "", Range{0, 200},
                              "Of its chain; 0: a rope without weight, to its centre."),
           key<&Given::material>("material", "What ball and chain are made of."),
           key<&Given::name>("name", "Shown in messages.")}};
}

Keys<Blast> blast_keys() {
  return {"[[script.blast]]",
          {key<&Blast::time_s>("time_s", "s", kTime, "When.").must(),
           key<&Blast::center_W>("at", "m", kPlace, "Its centre.").must(),
           key<&Blast::radius_m>("radius_m", "m", Range{0.01, 1000}, "How far it reaches."),
           key<&Blast::cover>("cover",
                              "Whether what stands nearer covers what is behind it; else nothing "
                              "stands in its way."),
           key<&Blast::impulse_Ns_m2>("impulse_Ns_m2", "N·s/m²", Range{0.001, 1e9},
                                      "On a face turned to the centre, there; less with "
                                      "distance and slant."),
           key<&Blast::tnt_kg>("tnt_kg", "kg", Range{0.001, 1e6},
                               "Mass of a charge of TNT, in place of radius_m and impulse_Ns_m2: "
                               "the impulse of its wave is known at every distance."),
           choice<&Blast::burst>("burst", kBursts,
                                 "With tnt_kg: ground: the charge lies on the ground, or just "
                                 "above; air: it is far from any ground.")}};
}

Keys<RemoveTable> remove_keys() {
  return {"[[script.remove]]",
          {key<&RemoveTable::time_s>("time_s", "s", kTime, "When.").must(),
           key<&RemoveTable::name>("name", "A solid or ball that goes with all its pieces; or:"),
           key<&RemoveTable::from>("from", "m", kPlace,
                                   "A corner of a box; what is anchored in it is let go."),
           key<&RemoveTable::to>("to", "m", kPlace, "The opposite corner.")}};
}

Keys<DriveTable> drive_keys() {
  return {
      "[[script.drive]]",
      {key<&DriveTable::name>("name", "The solid or ball that is driven until it breaks.").must(),
       key<&DriveTable::time_s>("time_s", "s", kTime, "From when."),
       key<&DriveTable::until_s>("until_s", "s", kTime, "Until when."),
       key<&DriveTable::velocity>("velocity", "m/s", kSpeed, "How it is to move."),
       key<&DriveTable::force_N>("force_N", "N", Range{0, 1e12}, "Most that drives it."),
       key<&DriveTable::angular_velocity>("angular_velocity", "rad/s", kSpeed,
                                          "How it is to spin."),
       key<&DriveTable::torque_Nm>("torque_Nm", "N·m", Range{0, 1e12}, "Most that spins it.")}};
}

Keys<MoveTable> move_keys() {
  using Given = MoveTable;
  return {"[[script.move]]",
          {key<&Given::name>("name",
                             "The solid or body that goes from where it stands through its keys, "
                             "whatever is in its way; it stays at the last, and does not break.")
               .must(),
           table_key("key", "Where it is when."),
           key<&Given::smooth>("smooth",
                               "Its velocity is continuous, and that of a path that ends begins "
                               "and ends with 0; false: straight from key to key."),
           key<&Given::loop>("loop",
                             "It begins again after its last key, which has it where it stood, "
                             "but for whole turns."),
           key<&Given::pivot>("pivot", "m", kPlace,
                              "What it turns about, before shifts; else the middle of its foot."),
           key<&Given::release_s>("release_s", "s", kTime,
                                  "From when on it is free, as fast as it is.")}};
}

Keys<MoveKeyTable> move_key_keys() {
  constexpr Range kTurns{-10000, 10000};
  using Given = MoveKeyTable;
  return {"[[script.move.key]]",
          {key<&Given::time_s>("time_s", "s", kTime, "When; later than the key before.").must(),
           key<&Given::shift>("shift", "m", kPlace, "From where it stood at the start."),
           key<&Given::turn_rad>("turn_rad", "rad", kTurns,
                                 "Likewise: the axis, times the angle; more than a turn is one.")}};
}

Schema make_schema() {
  Schema s;
  s.top = top_keys();
  s.scene = scene_keys();
  s.accuracy = {
      "[accuracy]",
      {key<&Accuracy::dt_s>("dt_s", "s", Range{1e-5, 1.0 / 60 + 1e-9},
                            "A step; 1/60 s is a whole number of them."),
       key<&Accuracy::substeps>("substeps", "", Range{1, kMaxSubsteps}, "Substeps of a step."),
       key<&Accuracy::error_target_m>(
           "error_target_m", "m", Range{0, 1},
           "In place of substeps: so many that what stands sinks in no farther, about; "
           "what it comes to is reported as penetration_m. 0: by substeps.")}};
  s.solver = solver_keys();
  s.limits = {
      "[limits]",
      {key<&Limits::bodies>("bodies", "", Range{1, 200000}, "Bodies that may exist."),
       key<&Limits::ageing>(
           "ageing", "", Range{0, 200000},
           "From so many on, the smallest fragments at rest become debris; 0: when "
           "room is short."),
       key<&Limits::parts_a_frame>("parts_a_frame", "", Range{1, 1000000},
                                   "Parts to cut, about: cells of a pattern, and eight for each "
                                   "convex in its reach; breaks beyond it wait a frame."),
       key<&Limits::load_work_a_frame>("load_work_a_frame", "", Range{1, 4e9},
                                       "Visits of bonds to find out what load breaks; the rest "
                                       "waits a frame."),
       key<&Limits::debris>("debris", "", Range{0, 200000}, "Pieces of debris alive at once."),
       key<&Limits::dust>("dust", "", Range{0, 100000}, "Puffs of dust alive at once."),
       key<&Limits::impact_bonds>("impact_bonds", "", Range{0, 4e9},
                                  "Bonds of a solid with a pattern above which impacts break it "
                                  "where it is struck only, not by stress elsewhere."),
       key<&Limits::impact_evaluations>("impact_evaluations", "", Range{1, 4e9},
                                        "Bond evaluations to find the stress of an impact on a "
                                        "solid; an impact that needs more breaks nothing by "
                                        "stress."),
       key<&Limits::loaded_convexes>("loaded_convexes", "", Range{2, 1000000},
                                     "Convexes of a brittle piece below which contacts do not "
                                     "break it by stress."),
       key<&Limits::cluster_bodies>("cluster_bodies", "", Range{2, 10000},
                                    "Moving bodies around an impact that it can reach within a "
                                    "step, the nearest first; three eighths of it if neither of "
                                    "the two that meet can break."),
       key<&Limits::probe_events>(
           "probe_events", "", Range{2, 10000},
           "Times at which contacts of a cluster close in a step, the first 12 in order and the "
           "others by energy; what closes after them breaks nothing."),
       key<&Limits::break_rounds>("break_rounds", "", Range{1, 1000},
                                  "Rounds of breaks in a step: solids that break one behind the "
                                  "other.")}};
  s.ground = {"[ground]",
              {key<&Ground::height_m>("height_m", "m", kPlace, "Height of the plane."),
               key<&Ground::friction>("friction", "", Range{0, 10}, "Coefficient of friction."),
               key<&Ground::restitution>("restitution", "", kFraction, "Bounce."),
               table_key("mesh", "Ground that is no plane.")}};
  s.view = {"[view]",
            {key<&View::eye_W>("eye", "m", kPlace, "Where the camera is."),
             key<&View::target_W>("target", "m", kPlace, "What it looks at."),
             key<&View::fov_rad>("fov_rad", "rad", Range{0.02, 3}, "Vertical angle of view."),
             key<&View::to_sun_W>("sun", "", kPlace, "Direction towards the sun."),
             key<&View::ground_color>("ground_color", "", kFraction, "Linear red, green, blue."),
             key<&View::exposure>("exposure", "", Range{0, 1000},
                                  "What is seen is this times as bright."),
             key<&View::shutter>("shutter", "", kFraction,
                                 "How much of the time between frames it is open: what moves is "
                                 "blurred so far, by render --samples."),
             key<&View::sun_color>("sun_color", "", kLight,
                                   "Light on a face turned to the sun: linear red, green, blue."),
             key<&View::sun_strength>("sun_strength", "", kLight, "Times sun_color."),
             key<&View::sky_color>("sky_color", "", kLight,
                                   "Light of the sky on a face turned up, likewise; what is seen "
                                   "of it follows."),
             key<&View::sky_strength>("sky_strength", "", kLight, "Times sky_color."),
             table_key("key", "Where the camera is when.")}};
  s.view_key = {
      "[[view.key]]",
      {key<&ViewKey::time_s>("time_s", "s", kTime, "When; later than the key before.").must(),
       key<&ViewKey::eye_W>("eye", "m", kPlace, "Where the camera is; as before if not given."),
       key<&ViewKey::target_W>("target", "m", kPlace, "What it looks at; likewise."),
       key<&ViewKey::fov_rad>("fov_rad", "rad", Range{0.02, 3},
                              "Vertical angle of view; likewise.")}};
  s.material_head = {
      "[[material]]",
      {key<&MaterialHead::name>("name", "What solids call it.").must(),
       key<&MaterialHead::like>("like", "The material it starts from; its namesake by default.")}};
  s.material = material_keys();
  s.pattern = pattern_keys();
  s.stronger = stronger_keys();
  s.crumbling = crumbling_keys();
  s.look = {"[material.surface], [material.interior]",
            {choice<&Look::texture>("texture", kTextures, "Procedural texture."),
             key<&Look::color>("color", "", kFraction, "Linear red, green, blue.")}};
  s.solid = solid_keys();
  s.part = {"[[solid.part]]",
            {key<&PartHead::structure>("structure", "Which structure; its keys as in [[solid]].")
                 .must()}};
  s.ball = {"[[ball]]",
            {key<&BallTable::name>("name", "Shown in messages."),
             key<&BallTable::position>("position", "m", kPlace, "Of its centre."),
             key<&BallTable::velocity>("velocity", "m/s", kSpeed, "At the start."),
             key<&BallTable::radius_m>("radius_m", "m", kRadius, "Radius."),
             key<&BallTable::material>("material", "What it is made of.")}};
  s.script = {
      "[script]",
      {key<&Script::enabled>("enabled", "false: nothing of it happens."),
       table_key("shot", "Balls that are shot."), table_key("wrecking_ball", "Balls on chains."),
       table_key("blast", "Blasts."), table_key("remove", "Supports that go."),
       table_key("drive", "Bodies that are driven."), table_key("move", "Bodies that go a path.")}};
  s.shot = shot_keys();
  s.wrecking_ball = wrecking_ball_keys();
  s.blast = blast_keys();
  s.remove = remove_keys();
  s.drive = drive_keys();
  s.move = move_keys();
  s.move_key = move_key_keys();
  return s;
}

}  // namespace

std::span<const Preset> presets() {
  static constexpr Preset kPresets[] = {
      {"draft", {1.0 / 60, 8}, 1, "fastest"},
      {"realtime", {1.0 / 120, 4}, 1, "the default"},
      {"accurate", {1.0 / 120, 8}, 1, "a quarter of the penetration"},
      {"reference", {1.0 / 480, 4}, 4, "a sixteenth of it"},
  };
  return kPresets;
}

std::span<const std::string_view> anchored_names() { return kAnchored; }

const Schema& schema() {
  static const Schema kSchema = make_schema();
  return kSchema;
}

}  // namespace sunder::scenes
