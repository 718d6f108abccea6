// The tables and keys of a scene file. Defaults are those of the objects that keys are stored in.
#include "scenes/file/schema.h"

namespace sunder::scenes {
namespace {

using ranges::kAtLeastZero, ranges::kFraction, ranges::kSpeed_m_s, ranges::kSpin_rad_s;
constexpr Range kPlace = ranges::kPlace_m;
constexpr Range kRadius = ranges::kLength_m;
constexpr Range kTime = ranges::kFileTime_s;
constexpr Range kLight{0, 100};

constexpr std::string_view kPatterns[] = {"none",  "voronoi", "web",  "radial",
                                          "brick", "slabs",   "grid", "file"};
constexpr std::string_view kTextures[] = {"plain", "brick", "concrete", "plaster",
                                          "wood",  "glass", "metal"};
constexpr std::string_view kBursts[] = {"ground", "air"};
constexpr std::string_view kAnchored[] = {"none", "bottom", "all", "own"};

Keys<Scene> top_keys() {
  return {"the scene file",
          {table_key("scene", "General settings."),
           table_key("accuracy", "Time step and substeps; overrides the preset."),
           table_key("solver", "Settings of the contact solver."),
           table_key("limits", "Limits of counts and work."),
           table_key("ground", "The ground plane and ground meshes."),
           table_key("view", "Camera and light."), table_key("material", "Materials."),
           table_key("solid", "Generated structures."), table_key("body", "Bodies from meshes."),
           table_key("ball", "Balls that exist from the start."),
           table_key("joint", "Joints between bodies."),
           table_key("script", "Actions at given times.")}};
}

Keys<Scene> scene_keys() {
  return {
      "[scene]",
      {key<&Scene::description>("description", "One line for `sunder list`.").must(),
       key<&Scene::duration_s>("duration_s", "s", Range{0.1, 600}, "Simulated time."),
       key<&Scene::seed>("seed", "", Range{0, 9e15}, "Seed of all random numbers."),
       key<&Scene::gravity_W>("gravity", "m/s²", ranges::kGravity_m_s2,
                              "Acceleration due to gravity."),
       key<&Scene::planar>("planar",
                           "Simulate in the plane z = 0: solids are prisms along z that cross it, "
                           "balls are centred in it, and nothing moves along z.")}};
}

Keys<SolverOptions> solver_keys() {
  return {"[solver]",
          {key<&SolverOptions::max_colors>(
               "max_colors", "", ranges::kMaxColors,
               "Most colours of contacts. 64: coloured Gauss-Seidel, with mass splitting for "
               "contacts without a colour; 0: mass splitting for all."),
           key<&SolverOptions::sweeps>("sweeps", "", ranges::kSweeps,
                                       "Sweeps of each kind in a substep; from 4 on with conjugate "
                                       "gradients. 4 at `reference`."),
           key<&SolverOptions::lanes>("lanes", "", ranges::kLanes,
                                      "Contacts that one instruction solves: 1, 4, 8 or 16; 0: the "
                                      "most that the processor has. Results are bit-identical.")}};
}

Keys<Material> material_keys() {
  return {
      "[[material]]",
      {key<&Material::density_kg_m3>("density_kg_m3", "kg/m³", ranges::kDensity_kg_m3, "Density."),
       key<&Material::friction>("friction", "", ranges::kFriction, "Coefficient of friction."),
       key<&Material::rolling>(
           "rolling", "", ranges::kRolling,
           "Coefficient of rolling resistance: torque over normal force and radius."),
       key<&Material::restitution>("restitution", "", kFraction,
                                   "Coefficient of restitution: 0 = no bounce, 1 = full."),
       key<&Material::strength_Ns>("strength_Ns", "N·s", kAtLeastZero,
                                   "Obsolete: smallest contact impulse that breaks the material, "
                                   "whatever its stress limits."),
       key<&Material::toughness_J_m2>("toughness_J_m2", "J/m²", kAtLeastZero,
                                      "Fracture energy per area of crack."),
       key<&Material::tensile_Pa>("tensile_Pa", "Pa", kAtLeastZero,
                                  "Tensile strength of bonds; 0: unlimited."),
       key<&Material::shear_Pa>("shear_Pa", "Pa", kAtLeastZero,
                                "Shear strength of bonds; 0: unlimited."),
       key<&Material::compressive_Pa>("compressive_Pa", "Pa", kAtLeastZero,
                                      "Compressive strength of bonds; 0: unlimited."),
       key<&Material::reinforcement_percent>(
           "reinforcement_percent", "%", ranges::kReinforcement_percent,
           "Steel reinforcement in each direction and each face, which resists perforation."),
       key<&Material::youngs_Pa>("youngs_Pa", "Pa", ranges::kYoungs_Pa,
                                 "Young's modulus, which determines how bonds share a load."),
       key<&Material::yield_Pa>(
           "yield_Pa", "Pa", kAtLeastZero,
           "Yield stress, at which the material bends instead of breaking; 0: it does not yield."),
       key<&Material::hardening_Pa>(
           "hardening_Pa", "Pa", ranges::kHardening_Pa,
           "Increase of the yield stress at an elongation of 1 (twice the length)."),
       key<&Material::elongation>(
           "elongation", "", ranges::kElongation,
           "Elongation, relative to the length, at which the yielding material tears."),
       key<&Material::impact_radius_m>(
           "impact_radius_m", "m", ranges::kImpactRadius_m,
           "Radius around an impact within which the material breaks; inf: everywhere."),
       key<&Material::smallest_break_m3>("smallest_break_m3", "m³", kAtLeastZero,
                                         "Obsolete: pieces below this volume do not break. "
                                         "Default: eight times smallest_piece_m3."),
       key<&Material::smallest_piece_m3>(
           "smallest_piece_m3", "m³", kAtLeastZero,
           "Pieces below this volume become debris instead of bodies."),
       key<&Material::fit>("fit",
                           "Shape that encloses each convex of a broken mesh for collisions."),
       table_key("pattern", "Fracture pattern."),
       table_key("stronger", "Patterns of stronger impacts."),
       table_key("crumbling", "Debris and dust from new crack faces."),
       table_key("surface", "Appearance of the outside."),
       table_key("interior", "Appearance of crack faces.")}};
}

Keys<PatternSpec> pattern_keys() {
  return {"[material.pattern]",
          {choice<&PatternSpec::kind>("kind", kPatterns, "none: the material does not break."),
           key<&PatternSpec::cells>("cells", "", ranges::kCells,
                                    "voronoi: sites; radial: sectors; slabs: slabs; grid: cells "
                                    "along each side, at most 30."),
           key<&PatternSpec::falloff>(
               "falloff", "", ranges::kFalloff,
               "voronoi: 1 = uniform density of sites, more = smaller cells near the impact."),
           key<&PatternSpec::rings>("rings", "", ranges::kRings, "web: rings."),
           key<&PatternSpec::spokes>("spokes", "", ranges::kSpokes, "web: spokes."),
           key<&PatternSpec::jitter>("jitter", "", kFraction,
                                     "web, radial, slabs: irregularity, 0 = regular."),
           key<&PatternSpec::brick_m>("brick_m", "m", ranges::kBrick_m,
                                      "brick: length, height and depth of a brick."),
           key<&PatternSpec::file>("file",
                                   "file: an .obj of convex cells, one per group, that fill a box "
                                   "around the impact; relative to the folder of the scene."),
           key<&PatternSpec::colors>("colors", "", ranges::kColors,
                                     "Number of pieces into which cells are joined, which need not "
                                     "be convex; 0: each cell is a piece.")}};
}

Keys<ImpactResponse> stronger_keys() {
  return {"[[material.stronger]]",
          {key<&ImpactResponse::energy_J>(
               "energy_J", "J", kAtLeastZero,
               "Impact energy from which on this entry applies; entries are in ascending order.")
               .must(),
           key<&ImpactResponse::impact_radius_m>(
               "impact_radius_m", "m", ranges::kImpactRadius_m,
               "Replaces that of the material, which is the default."),
           table_key("pattern", "Replaces that of the material, whose values are the defaults.")}};
}

Keys<DebrisEmission> crumbling_keys() {
  constexpr Range kSize = ranges::kDebrisRadius_m;
  return {"[material.crumbling]",
          {key<&DebrisEmission::particles_per_m2>(
               "particles_per_m2", "1/m²", ranges::kParticles_per_m2,
               "Particles of debris and dust per area of new crack faces; 0: none."),
           key<&DebrisEmission::debris_ratio>(
               "debris_ratio", "", kFraction,
               "Fraction of the particles that are debris; the others are dust."),
           key<&DebrisEmission::debris_smallest_m>("debris_smallest_m", "m", kSize,
                                                   "Smallest radius of debris."),
           key<&DebrisEmission::debris_largest_m>(
               "debris_largest_m", "m", kSize,
               "Largest radius of debris; most radii are near the smallest."),
           key<&DebrisEmission::dust_kg_m2>(
               "dust_kg_m2", "kg/m²", ranges::kDust_kg_m2,
               "Mass of dust per area of new crack faces, which makes the air heavier."),
           key<&DebrisEmission::dust_settling_m_s>("dust_settling_m_s", "m/s",
                                                   ranges::kDustSettling_m_s,
                                                   "Settling speed of dust in still air.")}};
}

Keys<SolidHead> solid_keys() {
  return {"[[solid]]",
          {key<&SolidHead::structure>("structure", "Type of structure, whose keys follow below.")
               .must(),
           key<&SolidHead::name>("name", "Name in messages; that of the structure by default."),
           key<&SolidHead::velocity>("velocity", "m/s", kSpeed_m_s, "Initial velocity."),
           key<&SolidHead::angular_velocity>("angular_velocity", "rad/s", kSpin_rad_s,
                                             "Initial angular velocity."),
           choice<&SolidHead::anchored>(
               "anchored", kAnchored,
               "bottom: the lowest parts are fixed to the world from below; all: all parts are "
               "fixed on all sides; none: the solid is free; own: as the structure is built, which "
               "stands on anchored feet or is free.")}};
}

Keys<ShotTable> shot_keys() {
  return {"[[script.shot]]",
          {key<&ShotTable::time_s>("time_s", "s", kTime, "Time at which the ball appears.").must(),
           key<&ShotTable::from>("from", "m", kPlace, "Initial position of the centre.").must(),
           key<&ShotTable::velocity>("velocity", "m/s", kSpeed_m_s,
                                     "Initial velocity; alternatively `at`."),
           key<&ShotTable::at>("at", "m", kPlace, "Target, aimed at in a straight line."),
           key<&ShotTable::speed_m_s>("speed_m_s", "m/s", Range{0, kSpeed_m_s.high},
                                      "Initial speed, with `at`."),
           key<&ShotTable::radius_m>("radius_m", "m", kRadius, "Radius of the ball."),
           key<&ShotTable::material>("material", "Material of the ball."),
           key<&ShotTable::name>("name", "Name in messages.")}};
}

Keys<WreckingBallTable> wrecking_ball_keys() {
  using Given = WreckingBallTable;
  return {"[[script.wrecking_ball]]",
          {key<&Given::time_s>("time_s", "s", kTime, "Time at which the ball appears."),
           key<&Given::from>("from", "m", kPlace, "Initial position of the centre.").must(),
           key<&Given::hangs_from>(
               "hangs_from", "m", kPlace,
               "Suspension point; the chain is as long as its distance from the ball.")
               .must(),
           key<&Given::velocity>("velocity", "m/s", kSpeed_m_s, "Initial velocity."),
           key<&Given::radius_m>("radius_m", "m", kRadius, "Radius of the ball."),
           key<&Given::links>("links", "", Range{0, 200},
                              "Links of the chain; 0: a massless rope to the centre of the ball."),
           key<&Given::material>("material", "Material of ball and chain."),
           key<&Given::name>("name", "Name in messages.")}};
}

Keys<Blast> blast_keys() {
  return {"[[script.blast]]",
          {key<&Blast::time_s>("time_s", "s", kTime, "Time of the blast.").must(),
           key<&Blast::center_W>("at", "m", kPlace, "Centre of the blast.").must(),
           key<&Blast::radius_m>("radius_m", "m", ranges::kBlastRadius_m,
                                 "Radius beyond which the blast has no effect."),
           key<&Blast::cover>(
               "cover", "true: nearer bodies shield those behind them; false: nothing shields."),
           key<&Blast::impulse_Ns_m2>("impulse_Ns_m2", "N·s/m²", ranges::kBlastImpulse_Ns_m2,
                                      "Impulse per area at the centre, on a face towards it; "
                                      "decreases with distance and slant."),
           key<&Blast::tnt_kg>("tnt_kg", "kg", ranges::kTnt_kg,
                               "Mass of a charge of TNT, from which the impulse is computed; "
                               "replaces radius_m and impulse_Ns_m2."),
           choice<&Blast::burst>("burst", kBursts,
                                 "With tnt_kg: ground: the charge is on or just above the ground; "
                                 "air: it is far from any ground.")}};
}

Keys<RemoveTable> remove_keys() {
  return {"[[script.remove]]",
          {key<&RemoveTable::time_s>("time_s", "s", kTime, "Time of the removal.").must(),
           key<&RemoveTable::name>(
               "name",
               "Solid or ball that is removed with all its pieces; alternatively `from` and `to`."),
           key<&RemoveTable::from>("from", "m", kPlace,
                                   "Corner of a box, in which anchored parts are released."),
           key<&RemoveTable::to>("to", "m", kPlace, "Opposite corner of the box.")}};
}

Keys<DriveTable> drive_keys() {
  return {"[[script.drive]]",
          {key<&DriveTable::name>("name", "Solid or ball that is driven until it breaks.").must(),
           key<&DriveTable::time_s>("time_s", "s", kTime, "Start time."),
           key<&DriveTable::until_s>("until_s", "s", kTime, "End time."),
           key<&DriveTable::velocity>("velocity", "m/s", kSpeed_m_s, "Target velocity."),
           key<&DriveTable::force_N>("force_N", "N", ranges::kForce, "Maximum force."),
           key<&DriveTable::angular_velocity>("angular_velocity", "rad/s", kSpin_rad_s,
                                              "Target angular velocity."),
           key<&DriveTable::torque_Nm>("torque_Nm", "N·m", ranges::kForce, "Maximum torque.")}};
}

Keys<MoveTable> move_keys() {
  using Given = MoveTable;
  return {
      "[[script.move]]",
      {key<&Given::name>("name",
                         "Solid or body that follows the keys as a kinematic body, which nothing "
                         "stops or breaks; it rests at the last key.")
           .must(),
       table_key("key", "Poses at given times."),
       key<&Given::smooth>("smooth",
                           "true: the velocity is continuous, and 0 at the start and the end of a "
                           "path that ends; false: straight from key to key."),
       key<&Given::loop>(
           "loop",
           "Repeat the path; its last key must be the initial pose, except for whole revolutions."),
       key<&Given::pivot>(
           "pivot", "m", kPlace,
           "Initial position of the centre of rotation; the middle of the foot by default."),
       key<&Given::release_s>(
           "release_s", "s", kTime,
           "Time from which on the body moves freely, with the velocity that it has.")}};
}

Keys<MoveKeyTable> move_key_keys() {
  constexpr Range kTurns{-10000, 10000};
  using Given = MoveKeyTable;
  return {
      "[[script.move.key]]",
      {key<&Given::time_s>("time_s", "s", kTime, "Time of the key, after that of the previous key.")
           .must(),
       key<&Given::shift>("shift", "m", kPlace, "Displacement from the initial position."),
       key<&Given::turn_rad>("turn_rad", "rad", kTurns,
                             "Rotation from the initial orientation: axis times angle, which may "
                             "exceed a revolution.")}};
}

Schema make_schema() {
  Schema s;
  s.top = top_keys();
  s.scene = scene_keys();
  s.accuracy = {
      "[accuracy]",
      {key<&Accuracy::dt_s>("dt_s", "s", ranges::kFileStep_s,
                            "Time step; 1/60 s must be a whole number of steps."),
       key<&Accuracy::substeps>("substeps", "", ranges::kSubsteps, "Substeps per step."),
       key<&Accuracy::error_target_m>(
           "error_target_m", "m", ranges::kErrorTarget_m,
           "Target penetration of stacks, from which the substeps are computed, approximately; the "
           "actual one is reported as penetration_m. 0: use substeps.")}};
  s.solver = solver_keys();
  s.limits = {
      "[limits]",
      {key<&Limits::bodies>("bodies", "", ranges::kBodies, "Most bodies at once."),
       key<&Limits::ageing>("ageing", "", ranges::kAgeing,
                            "Number of bodies from which on the smallest fragments at rest become "
                            "debris; 0: only at the limit of bodies."),
       key<&Limits::parts_a_frame>(
           "parts_a_frame", "", ranges::kPartsAFrame,
           "Parts that breaks may cut in a frame, approximately: cells of a pattern, and eight for "
           "each convex in its radius; further breaks are deferred to the next frame."),
       key<&Limits::load_work_a_frame>("load_work_a_frame", "", ranges::kWork,
                                       "Bond evaluations per frame to find breaks by load; the "
                                       "rest is deferred to the next frame."),
       key<&Limits::debris>("debris", "", ranges::kDebris, "Most debris particles at once."),
       key<&Limits::dust>("dust", "", ranges::kDust, "Most dust particles at once."),
       key<&Limits::impact_bonds>("impact_bonds", "", ranges::kImpactBonds,
                                  "Bonds of a solid with a pattern above which impacts break it "
                                  "where it is struck only, not by stress elsewhere."),
       key<&Limits::impact_evaluations>("impact_evaluations", "", ranges::kWork,
                                        "Bond evaluations to find the stress of an impact on a "
                                        "solid; an impact that needs more breaks nothing by "
                                        "stress."),
       key<&Limits::loaded_convexes>("loaded_convexes", "", ranges::kLoadedConvexes,
                                     "Convexes of a brittle piece below which contacts do not "
                                     "break it by stress."),
       key<&Limits::cluster_bodies>("cluster_bodies", "", ranges::kClusterBodies,
                                    "Moving bodies around an impact that it can reach within a "
                                    "step, the nearest first; three eighths of it if neither of "
                                    "the two that meet can break."),
       key<&Limits::probe_events>(
           "probe_events", "", ranges::kProbeEvents,
           "Times at which contacts of a cluster close in a step, the first 12 in order and the "
           "others by energy; what closes after them breaks nothing."),
       key<&Limits::break_rounds>("break_rounds", "", ranges::kBreakRounds,
                                  "Rounds of breaks in a step: solids that break one behind the "
                                  "other."),
       key<&Limits::full_detail>(
           "full_detail", "", ranges::kFullDetail,
           "Awake bodies above which the smallest piece that is a body grows: smallest_piece_m3 is "
           "multiplied by the awake bodies over this number; 0: never."),
       key<&Limits::piece_size_factor>(
           "piece_size_factor", "", ranges::kPieceSizeFactor,
           "Factor on the size of the smallest pieces that are bodies, the cube root of "
           "smallest_piece_m3: smaller pieces become debris."),
       key<&Limits::chip_size_factor>("chip_size_factor", "", ranges::kChipSizeFactor,
                                      "Factor on debris_smallest_m: smaller debris is left out."),
       key<&Limits::passed_impacts>("passed_impacts",
                                    "false: impacts break only the two bodies that meet, not those "
                                    "that they are passed on to.")}};
  s.ground = {
      "[ground]",
      {key<&Ground::height_m>("height_m", "m", kPlace, "Height of the plane."),
       key<&Ground::friction>("friction", "", ranges::kFriction, "Coefficient of friction."),
       key<&Ground::restitution>("restitution", "", kFraction, "Coefficient of restitution."),
       table_key("mesh", "Ground meshes, in addition to the plane.")}};
  s.view = {
      "[view]",
      {key<&View::eye_W>("eye", "m", kPlace, "Position of the camera."),
       key<&View::target_W>("target", "m", kPlace, "Point that the camera looks at."),
       key<&View::fov_rad>("fov_rad", "rad", Range{0.02, 3}, "Vertical field of view."),
       key<&View::to_sun_W>("sun", "", kPlace, "Direction towards the sun."),
       key<&View::ground_color>("ground_color", "", kFraction,
                                "Colour of the ground: linear red, green, blue."),
       key<&View::exposure>("exposure", "", Range{0, 1000}, "Brightness factor of the image."),
       key<&View::shutter>("shutter", "", kFraction,
                           "Fraction of the time between frames in which the shutter is open: "
                           "motion blur by render --samples."),
       key<&View::sun_color>("sun_color", "", kLight,
                             "Light on a face turned to the sun: linear red, green, blue."),
       key<&View::sun_strength>("sun_strength", "", kLight, "Factor of sun_color."),
       key<&View::sky_color>("sky_color", "", kLight,
                             "Light of the sky on a face turned up: linear red, green, blue; also "
                             "determines the visible sky."),
       key<&View::sky_strength>("sky_strength", "", kLight, "Factor of sky_color."),
       table_key("key", "Poses of the camera at given times.")}};
  s.view_key = {
      "[[view.key]]",
      {key<&ViewKey::time_s>("time_s", "s", kTime,
                             "Time of the key, after that of the previous key.")
           .must(),
       key<&ViewKey::eye_W>("eye", "m", kPlace,
                            "Position of the camera; by default that of the previous key."),
       key<&ViewKey::target_W>(
           "target", "m", kPlace,
           "Point that the camera looks at; by default that of the previous key."),
       key<&ViewKey::fov_rad>("fov_rad", "rad", Range{0.02, 3},
                              "Vertical field of view; by default that of the previous key.")}};
  s.material_head = {
      "[[material]]",
      {key<&MaterialHead::name>("name", "Name that solids use.").must(),
       key<&MaterialHead::like>(
           "like",
           "Material whose values are the defaults; by default the one of the same name.")}};
  s.material = material_keys();
  s.pattern = pattern_keys();
  s.stronger = stronger_keys();
  s.crumbling = crumbling_keys();
  s.look = {"[material.surface], [material.interior]",
            {choice<&Look::texture>("texture", kTextures, "Procedural texture."),
             key<&Look::color>("color", "", kFraction, "Colour: linear red, green, blue.")}};
  s.solid = solid_keys();
  s.part = {
      "[[solid.part]]",
      {key<&PartHead::structure>("structure", "Type of structure; its keys are those in [[solid]].")
           .must()}};
  s.ball = {"[[ball]]",
            {key<&BallTable::name>("name", "Name in messages."),
             key<&BallTable::position>("position", "m", kPlace, "Position of the centre."),
             key<&BallTable::velocity>("velocity", "m/s", kSpeed_m_s, "Initial velocity."),
             key<&BallTable::radius_m>("radius_m", "m", kRadius, "Radius of the ball."),
             key<&BallTable::material>("material", "Material of the ball.")}};
  s.script = {
      "[script]",
      {key<&Script::enabled>("enabled", "false: no action takes place."),
       table_key("shot", "Balls that are shot."), table_key("wrecking_ball", "Wrecking balls."),
       table_key("blast", "Blasts."), table_key("remove", "Removal of supports."),
       table_key("drive", "Forces towards a target velocity."),
       table_key("move", "Bodies on given paths.")}};
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
      {"draft", {1.0 / 60, 8}, 1, 200, 2, "fastest; larger pieces where many move"},
      {"realtime", {1.0 / 120, 4}, 1, 0, 1, "the default"},
      {"accurate", {1.0 / 120, 8}, 1, 0, 1, "a quarter of the penetration of the default"},
      {"reference", {1.0 / 480, 4}, 4, 0, 1, "a sixteenth of the penetration of the default"},
  };
  return kPresets;
}

std::span<const std::string_view> anchored_names() { return std::span(kAnchored).first(3); }

const Schema& schema() {
  static const Schema kSchema = make_schema();
  return kSchema;
}

}  // namespace sunder::scenes
