// The C interface of Sunder: worlds that a program in C, or in any language that can call C, makes,
// acts on and asks. It has the calls of the C++ class World (world.h).
//
//   SunderWorldDef def = sunder_default_world_def();
//   def.scene = "house";
//   SunderWorld world;
//   if (sunder_world_create(&def, &world) != SUNDER_OK) puts(sunder_last_error());
//   for (int i = 0; i < 60; ++i) sunder_world_step(world, 1.0 / 60);
//   sunder_world_destroy(world);
//
// Conventions. SI units, right-handed, y up, radians. Names end in their unit; vectors in their
// frame: _W is the world. X_WR is the pose of the rest frame R, in which a solid was modelled, in
// the world. Rotations are unit quaternions.
//
// Handles. A world or an asset is known by a handle, a body or a joint by a key within its world.
// Neither is used again, so that a handle or key of something that is gone, that is null or was
// never issued is refused with SUNDER_ERROR_HANDLE. All functions take handles and keys by value.
//
// Errors. Each function that can fail returns a SunderResult. Unless it is SUNDER_OK,
// sunder_last_error() describes it, outputs are unchanged (but for counts, where said), and the
// world is as before; only after SUNDER_ERROR_MEMORY and SUNDER_ERROR_INTERNAL of a function that
// changes a world may the world be incomplete: it then refuses all calls but
// sunder_world_destroy(). No exception leaves a function. A failed internal check, which is a
// defect of Sunder, prints its place and aborts the program; so does a step that has no memory left
// on one of its threads.
//
// Threads. All functions may be called from any thread. Calls for one world are carried out one
// after another; calls for different worlds at once. Pointers that a call returns belong to the
// world, and are valid until the next call that says so, from whichever thread it comes.
//
// Definitions. A struct named ...Def is filled by its default function, sunder_default_...(), and
// then changed; one without its default values is refused. Strings are UTF-8, null-terminated, and
// copied; a null string is an empty one.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define SUNDER_API __attribute__((visibility("default")))
#else
#define SUNDER_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/// Result of a call.
typedef enum SunderResult {
  SUNDER_OK = 0,
  SUNDER_ERROR_HANDLE = 1,    ///< A world, asset, body or joint does not exist, or no longer.
  SUNDER_ERROR_ARGUMENT = 2,  ///< An argument is null, out of its range, or not finite.
  SUNDER_ERROR_INPUT = 3,     ///< A scene or mesh, or a file with one, is wrong or cannot be read.
  SUNDER_ERROR_FILE = 4,      ///< A file cannot be written.
  SUNDER_ERROR_MEMORY = 5,    ///< There is not enough memory.
  SUNDER_ERROR_INTERNAL = 6   ///< A defect of Sunder, or a world that one has left incomplete.
} SunderResult;

/// Returns the name of a result, as in "SUNDER_ERROR_HANDLE"; never null.
SUNDER_API const char* sunder_result_name(SunderResult result);

/// Returns the message of the last call of this thread that failed, which begins with the name of
/// the function and names the argument; empty if none failed. Valid until the next failure.
SUNDER_API const char* sunder_last_error(void);

/// Returns the version, as in "1.0.0".
SUNDER_API const char* sunder_version(void);

/// Functions that replace malloc() and free(). Both are called by any thread, with the user pointer
/// of sunder_set_allocator(), and must not call functions of this interface. The memory is aligned
/// as by malloc(); null means that there is none.
typedef void* (*SunderAlloc)(size_t bytes, void* user);
/// Function that replaces free().
typedef void (*SunderFree)(void* memory, void* user);

/// Sets the functions that provide the memory which this interface keeps: the tables of handles,
/// the entry of each world and asset, and all arrays that it returns pointers to. They do not
/// provide the memory of bodies, shapes, solver and meshes, which are C++ containers that use
/// operator new: a program replaces that by defining operator new. Two null pointers restore
/// malloc() and free(). Refused (SUNDER_ERROR_ARGUMENT) while any world or asset exists, and if
/// only one pointer is null.
SUNDER_API SunderResult sunder_set_allocator(SunderAlloc allocate, SunderFree release, void* user);

// ---------------------------------------------------------------------------------------------
// Values
// ---------------------------------------------------------------------------------------------

/// A vector, or a point.
typedef struct SunderVec3 {
  double x, y, z;
} SunderVec3;

/// A rotation: (x, y, z) is the vector part. The identity is {0, 0, 0, 1}.
typedef struct SunderQuat {
  double x, y, z, w;
} SunderQuat;

/// A rigid transform: rotation, then translation.
typedef struct SunderPose {
  SunderVec3 position;
  SunderQuat rotation;
} SunderPose;

/// Handle of a world; all zero is null.
typedef struct SunderWorld {
  uint32_t index, generation;
} SunderWorld;

/// Handle of an asset; all zero is null.
typedef struct SunderAsset {
  uint32_t index, generation;
} SunderAsset;

/// Key of a body in its world: of a solid, a ball, or a piece of one. The bodies of the scene have
/// the keys 0, 1, ... in the order of its solids and then its balls.
typedef struct SunderBody {
  uint32_t key;
} SunderBody;

/// Key of a joint in its world.
typedef struct SunderJoint {
  uint32_t key;
} SunderJoint;

/// Handle of a material. That of a built-in one is valid in every world; any other stands for its
/// values in the worlds that have it: the world that it was asked of, copies and restored states of
/// that, and worlds made of the same scene. All others refuse it.
typedef struct SunderMaterial {
  uint32_t index;
} SunderMaterial;

/// The key that stands for the ground in results, and for the world as an end of a joint.
#define SUNDER_NO_KEY 0xffffffffu
/// The handle that stands for no material in results, such as the plane of the ground.
#define SUNDER_NO_MATERIAL 0xffffffffu

/// The sets of bits by which bodies collide: two do if the category of each has a bit in the mask
/// of the other. The ground is in all categories.
typedef struct SunderFilter {
  uint32_t category, mask;
} SunderFilter;

// ---------------------------------------------------------------------------------------------
// Worlds
// ---------------------------------------------------------------------------------------------

/// The scene of a new world, and options of its run. At most one of `scene` and `scene_text` is
/// given; without either the world has the built-in materials, a ground plane at the height 0, and
/// no bodies.
typedef struct SunderWorldDef {
  uint32_t cookie;    ///< Set by sunder_default_world_def().
  const char* scene;  ///< A scene file, or the name of a scene that comes with Sunder; or null.
  const char* scene_text;  ///< Content of a scene file; or null.
  /// Folder of the scenes that come with Sunder; null: that which was installed with the library.
  const char* scenes_folder;
  const char* preset;  ///< draft | realtime | accurate | reference; null: realtime.
  /// Assignments KEY=VALUE with a dotted key of the scene file, such as "scene.seed=2"; or null.
  const char* const* settings;
  uint32_t setting_count;
  int32_t threads;       ///< Threads of steps, up to 1024; 0: one for each processor.
  bool has_gravity;      ///< True: `gravity_W` replaces the scene's gravity.
  SunderVec3 gravity_W;  ///< In m/s².
  bool has_seed;         ///< True: `seed` replaces the scene's seed.
  uint64_t seed;
  bool particles;  ///< False: there are neither debris nor dust.
  /// Called with each warning to the user, a sentence, while the world is made and when it is
  /// destroyed, by the thread that does so; or null. It must neither throw nor call functions for
  /// this world. `warn_user` is passed on.
  void (*warn)(const char* warning, void* warn_user);
  void* warn_user;
} SunderWorldDef;

/// Returns an empty world of preset realtime with gravity 9.81 m/s² and particles.
SUNDER_API SunderWorldDef sunder_default_world_def(void);

/// Makes a world. SUNDER_ERROR_INPUT if the scene, the preset or a setting is wrong.
SUNDER_API SunderResult sunder_world_create(const SunderWorldDef* def, SunderWorld* world);
/// Destroys a world with all that is in it; pointers that it returned become invalid.
SUNDER_API SunderResult sunder_world_destroy(SunderWorld world);
/// Makes a world in the same state, which goes on with the same bits: to roll back, keep a copy,
/// and go on with it. What does not change is shared. SUNDER_ERROR_ARGUMENT for a planar scene.
SUNDER_API SunderResult sunder_world_copy(SunderWorld world, SunderWorld* copy);
/// Returns the state of a world as bytes, compressed, for sunder_world_restore(); worlds in equal
/// states have equal bytes. They are valid until the next call of this function for the world.
/// SUNDER_ERROR_ARGUMENT for a planar scene.
SUNDER_API SunderResult sunder_world_save(SunderWorld world, const void** bytes, size_t* size);
/// Makes a world in the state that sunder_world_save() of the same version has returned, in this or
/// another process; it goes on with the same bits. `threads` as in SunderWorldDef.
/// SUNDER_ERROR_INPUT for other bytes.
SUNDER_API SunderResult sunder_world_restore(const void* bytes, size_t size, int32_t threads,
                                             SunderWorld* world);
/// Returns true if the world exists.
SUNDER_API bool sunder_world_is_valid(SunderWorld world);

/// Advances a world by a time from 1e-6 to 0.1 s, in equal steps of at most the scene's step. A
/// frame of 1/60 s gives the same bits as `sunder simulate`. Pointers of sunder_world_events()
/// become invalid.
SUNDER_API SunderResult sunder_world_step(SunderWorld world, double time_s);

// ---------------------------------------------------------------------------------------------
// Materials
// ---------------------------------------------------------------------------------------------

/// Kinds of fracture patterns.
enum {
  SUNDER_PATTERN_NONE = 0,  ///< Unbreakable.
  SUNDER_PATTERN_VORONOI = 1,
  SUNDER_PATTERN_WEB = 2,
  SUNDER_PATTERN_RADIAL = 3,
  SUNDER_PATTERN_BRICK = 4,
  SUNDER_PATTERN_SLABS = 5,
  SUNDER_PATTERN_GRID = 6,
  SUNDER_PATTERN_FILE = 7  ///< Of a scene file; refused in definitions that do not copy it.
};

/// A fracture pattern.
typedef struct SunderPatternDef {
  uint32_t cookie;     ///< Set by the function that filled the definition.
  int32_t kind;        ///< SUNDER_PATTERN_...
  int32_t cells;       ///< By kind: sites, sectors or slabs, 2 to 5000; cells per side, 2 to 30.
  double falloff;      ///< Voronoi: 1 = uniform; up to 10 moves sites towards the impact.
  int32_t rings;       ///< Web, 1 to 100.
  int32_t spokes;      ///< Web, 3 to 200.
  double jitter;       ///< Web, radial, slabs: irregularity from 0 (regular) to 1.
  SunderVec3 brick_m;  ///< Brick: length, height and depth.
  int32_t colors;      ///< Number of pieces that cells are joined into; 0: each cell is a piece.
} SunderPatternDef;

/// Returns a Voronoi pattern of 50 cells.
SUNDER_API SunderPatternDef sunder_default_pattern_def(void);

/// The size of a buffer for a name, with its final null; longer names are cut off in results.
#define SUNDER_NAME_SIZE 64

/// A material. Members that are not listed here, such as the patterns of stronger impacts, are
/// copied from the material `base`.
typedef struct SunderMaterialDef {
  uint32_t cookie;      ///< Set by sunder_world_material_def().
  SunderMaterial base;  ///< The material that the definition is a copy of.
  char name[SUNDER_NAME_SIZE];
  double density_kg_m3;  ///< 1e-6 to 1e9.
  double friction;
  double restitution;     ///< 0 to 1.
  double rolling;         ///< Coefficient of rolling resistance.
  double toughness_J_m2;  ///< Energy per new crack area.
  SunderPatternDef pattern;
  double impact_radius_m;  ///< Radius in which an impact breaks, from 0.001; infinity: everywhere.
  double tensile_Pa;       ///< Stress that breaks bonds; 0: unlimited. So are the next two.
  double shear_Pa;
  double compressive_Pa;
  double reinforcement_percent;
  double youngs_Pa;
  double yield_Pa;           ///< 0: no yielding.
  double hardening_Pa;       ///< Increase of the yield stress per plastic strain.
  double elongation;         ///< Plastic strain at which a yielding section tears.
  double smallest_piece_m3;  ///< Smaller pieces become debris.
  float surface_color[3];    ///< Linear RGB of the original surface.
  float interior_color[3];   ///< Linear RGB of faces that a break made.
} SunderMaterialDef;

/// Finds a built-in material, such as "brick", "concrete", "glass", "steel" or "wood", whose handle
/// is valid in all worlds. SUNDER_ERROR_ARGUMENT if there is none of this name; the message lists
/// all.
SUNDER_API SunderResult sunder_builtin_material(const char* name, SunderMaterial* material);
/// Finds a material of a world: a built-in one, one of its scene, or one added.
SUNDER_API SunderResult sunder_world_material(SunderWorld world, const char* name,
                                              SunderMaterial* material);
/// Describes a material of a world, to draw it, or to add a changed copy.
SUNDER_API SunderResult sunder_world_material_def(SunderWorld world, SunderMaterial material,
                                                  SunderMaterialDef* def);
/// Adds a material. Names need not differ; the last material of a name is found by it.
SUNDER_API SunderResult sunder_world_add_material(SunderWorld world, const SunderMaterialDef* def,
                                                  SunderMaterial* material);

// ---------------------------------------------------------------------------------------------
// Assets: solids of which worlds can have any number
// ---------------------------------------------------------------------------------------------

/// A convex part of an asset: the hull of points, or, without points, a box along the axes.
typedef struct SunderPartDef {
  uint32_t cookie;           ///< Set by sunder_default_part_def().
  const SunderVec3* points;  ///< In R; or null.
  uint32_t point_count;
  SunderVec3 box_min, box_max;  ///< In R; used if `points` is null.
  SunderMaterial material;
  bool anchored;  ///< True: the part is fixed to the world from below, and its solid is static.
} SunderPartDef;

/// Returns a box of 1 m around the origin, of the built-in material concrete, not anchored.
SUNDER_API SunderPartDef sunder_default_part_def(void);

/// A mesh that is repaired and decomposed into convexes.
typedef struct SunderMeshDef {
  uint32_t cookie;  ///< Set by sunder_default_mesh_def().
  /// A file (.obj .ply .stl .off .gltf .glb), a built-in solid such as "torus:1,0.3", or a built-in
  /// mesh such as "statue:80000"; null: the triangles below.
  const char* mesh;
  const SunderVec3* vertices;  ///< In R.
  uint32_t vertex_count;
  const uint32_t* indices;  ///< Three for each triangle, counter-clockwise seen from outside.
  uint32_t index_count;
  SunderMaterial material;
  uint32_t convexes;  ///< Most convexes; 0: as many as the mesh needs.
  const char* nodes;  ///< Number of nodes of the decomposition, or a file; null: automatic.
  const char* fit;    ///< aabb | 14dop | 26dop | hull:N; null: hull:24.
  bool repair;        ///< False: a mesh that needs repair is refused.
  double scale;       ///< Metres for each unit of the file; for files only.
  double size_m;      ///< Longest side of the bounding box, in place of `scale`; 0: not given.
} SunderMeshDef;

/// Returns no mesh, of the built-in material concrete, repaired, with scale 1.
SUNDER_API SunderMeshDef sunder_default_mesh_def(void);

/// Makes an asset of convex parts, which are bonded where they touch. SUNDER_ERROR_ARGUMENT for a
/// part without volume, or with a point that is not finite or beyond 1e5 m.
SUNDER_API SunderResult sunder_asset_create_parts(const SunderPartDef* parts, uint32_t count,
                                                  SunderAsset* asset);
/// Makes an asset of a mesh. SUNDER_ERROR_INPUT if the file or mesh cannot be used.
SUNDER_API SunderResult sunder_asset_create_mesh(const SunderMeshDef* mesh, SunderAsset* asset);
/// Destroys an asset. Solids that were made of it remain, and keep what they need of it.
SUNDER_API SunderResult sunder_asset_destroy(SunderAsset asset);
/// Returns true if the asset exists.
SUNDER_API bool sunder_asset_is_valid(SunderAsset asset);

/// Figures of an asset.
typedef struct SunderAssetInfo {
  uint32_t convexes;
  uint32_t bonds;
  double volume_m3;
  SunderVec3 box_min, box_max;  ///< In R.
  bool anchored;                ///< True: solids of it are static.
} SunderAssetInfo;
/// Tells figures of an asset.
SUNDER_API SunderResult sunder_asset_info(SunderAsset asset, SunderAssetInfo* info);

// ---------------------------------------------------------------------------------------------
// Bodies and joints
// ---------------------------------------------------------------------------------------------

/// Pose and velocities of a body. The velocity is that of its centre of mass.
typedef struct SunderMotion {
  SunderPose X_WR;
  SunderVec3 velocity_W;          ///< In m/s.
  SunderVec3 angular_velocity_W;  ///< In rad/s.
} SunderMotion;

/// Returns rest at the origin.
SUNDER_API SunderMotion sunder_default_motion(void);

/// A solid, which is an asset placed in a world.
typedef struct SunderSolidDef {
  uint32_t cookie;  ///< Set by sunder_default_solid_def().
  SunderMotion motion;
  const char* name;
  uint64_t user_data;  ///< Any number; pieces inherit it.
  SunderFilter filter;
} SunderSolidDef;

/// Returns a solid at rest at the origin that collides with everything.
SUNDER_API SunderSolidDef sunder_default_solid_def(void);

/// A solid ball, which does not break.
typedef struct SunderBallDef {
  uint32_t cookie;  ///< Set by sunder_default_ball_def().
  double radius_m;
  SunderMaterial material;
  SunderVec3 center_W;
  SunderVec3 velocity_W;  ///< In m/s.
  const char* name;
  uint64_t user_data;
  SunderFilter filter;
} SunderBallDef;

/// Returns a ball of built-in steel with a radius of 0.5 m at the origin.
SUNDER_API SunderBallDef sunder_default_ball_def(void);

/// Kinds of joints.
enum {
  SUNDER_JOINT_BALL = 0,      ///< The anchors coincide.
  SUNDER_JOINT_HINGE = 1,     ///< The anchors coincide and the axes stay parallel.
  SUNDER_JOINT_FIXED = 2,     ///< The bodies do not move relative to each other.
  SUNDER_JOINT_DISTANCE = 3,  ///< The anchors keep their distance.
  SUNDER_JOINT_ROPE = 4       ///< The anchors are at most as far apart as now.
};

/// A joint of two bodies, or of a body and the world, in their present poses.
typedef struct SunderJointDef {
  uint32_t cookie;    ///< Set by sunder_default_joint_def().
  int32_t kind;       ///< SUNDER_JOINT_...
  SunderBody a, b;    ///< SUNDER_NO_KEY: the world.
  SunderVec3 at_W;    ///< Anchor on a; on b as well, except for distance and rope.
  SunderVec3 to_W;    ///< Distance and rope: anchor on b.
  SunderVec3 axis_W;  ///< Hinge: any length above 0.
  double breaking_N;  ///< The joint breaks above this force; infinity: never.
  double breaking_Nm;
  bool collide;  ///< True: the two bodies collide with each other.
} SunderJointDef;

/// Returns an unbreakable ball joint without bodies.
SUNDER_API SunderJointDef sunder_default_joint_def(void);

/// Adds a solid; `body` may be null. SUNDER_ERROR_ARGUMENT if the world lacks a material of the
/// asset.
SUNDER_API SunderResult sunder_world_add_solid(SunderWorld world, SunderAsset asset,
                                               const SunderSolidDef* solid, SunderBody* body);
/// Adds a ball; `body` may be null.
SUNDER_API SunderResult sunder_world_add_ball(SunderWorld world, const SunderBallDef* ball,
                                              SunderBody* body);
/// Adds a joint; `key` may be null.
SUNDER_API SunderResult sunder_world_add_joint(SunderWorld world, const SunderJointDef* joint,
                                               SunderJoint* key);

// ---------------------------------------------------------------------------------------------
// Act
// ---------------------------------------------------------------------------------------------

/// A ball that appears at a time.
typedef struct SunderShotDef {
  uint32_t cookie;     ///< Set by sunder_default_shot_def().
  double time_s;       ///< Time of the world; if it has passed, the ball appears in the next step.
  SunderBallDef ball;  ///< `center_W` is where the ball appears.
  bool hangs;          ///< True: the ball hangs on a massless rope from `hangs_from_W`.
  SunderVec3 hangs_from_W;
} SunderShotDef;

/// Returns a shot in the next step of the ball of sunder_default_ball_def().
SUNDER_API SunderShotDef sunder_default_shot_def(void);

/// An explosion: an impulse on every face turned to the centre.
typedef struct SunderBlastDef {
  uint32_t cookie;  ///< Set by sunder_default_blast_def().
  double time_s;    ///< Time of the world; if it has passed, the next step.
  SunderVec3 center_W;
  double radius_m;       ///< Reach of the impulse.
  double impulse_Ns_m2;  ///< Impulse per area at the centre.
  bool cover;            ///< True: nearer bodies shield those behind them.
  double tnt_kg;         ///< Above 0: mass of a TNT charge, in place of radius and impulse.
  bool in_air;           ///< True: the charge is not on the ground.
} SunderBlastDef;

/// Returns a blast in the next step at the origin of 1000 N s/m² with a reach of 4 m.
SUNDER_API SunderBlastDef sunder_default_blast_def(void);

/// A motor: holds bodies at a velocity by limited force, at an angular velocity by limited torque,
/// or both, until they break.
typedef struct SunderDriveDef {
  uint32_t cookie;           ///< Set by sunder_default_drive_def().
  double time_s, until_s;    ///< Times of the world.
  const SunderBody* bodies;  ///< Solids or balls, not pieces of them.
  uint32_t body_count;
  bool has_velocity;  ///< True: `velocity_W` is held.
  SunderVec3 velocity_W;
  double force_N;
  bool has_angular_velocity;  ///< True: `angular_velocity_W` is held.
  SunderVec3 angular_velocity_W;
  double torque_Nm;
} SunderDriveDef;

/// Returns a motor without bodies or velocities, from now on, with 1e6 N and 1e6 N m.
SUNDER_API SunderDriveDef sunder_default_drive_def(void);

/// Adds a ball that appears at a time. SUNDER_ERROR_ARGUMENT if the ball is invalid.
SUNDER_API SunderResult sunder_world_shoot(SunderWorld world, const SunderShotDef* shot);
/// Adds an explosion.
SUNDER_API SunderResult sunder_world_blast(SunderWorld world, const SunderBlastDef* blast);
/// Adds a motor. SUNDER_ERROR_HANDLE if one of its bodies does not exist.
SUNDER_API SunderResult sunder_world_drive(SunderWorld world, const SunderDriveDef* drive);

/// Removes a body, with its joints.
SUNDER_API SunderResult sunder_world_remove_body(SunderWorld world, SunderBody body);
/// Removes a joint.
SUNDER_API SunderResult sunder_world_remove_joint(SunderWorld world, SunderJoint joint);
/// Sets the pose and velocities of a body that is not anchored, and wakes it. Speeds are at most
/// 1e5 m/s and 1e6 rad/s along each axis.
SUNDER_API SunderResult sunder_world_set_motion(SunderWorld world, SunderBody body,
                                                const SunderMotion* motion);
/// Moves a body evenly to a pose within a time from 1e-6 s on, as a kinematic body: of infinite
/// mass, and unbreakable. It stays there until it is moved on or released.
SUNDER_API SunderResult sunder_world_move_to(SunderWorld world, SunderBody body, SunderPose X_WR,
                                             double duration_s);
/// Frees a kinematic body, which keeps its velocity, or removes all anchors of an anchored one.
SUNDER_API SunderResult sunder_world_release(SunderWorld world, SunderBody body);
/// Applies an impulse, in N s, at a point; has no effect on anchored and kinematic bodies.
SUNDER_API SunderResult sunder_world_apply_impulse(SunderWorld world, SunderBody body,
                                                   SunderVec3 impulse_W, SunderVec3 point_W);
/// Breaks a body in the next step, as an impact would that does work `energy_J` at the point of the
/// body nearest to `point_W`, along `direction_W`; by `pattern` in place of its material's, unless
/// that is null. The body holds if the energy is too little for the crack, or if its material is
/// unbreakable.
SUNDER_API SunderResult sunder_world_break_at(SunderWorld world, SunderBody body,
                                              SunderVec3 point_W, SunderVec3 direction_W,
                                              double energy_J, const SunderPatternDef* pattern);
/// Sets a number of the caller's, which pieces inherit.
SUNDER_API SunderResult sunder_world_set_user_data(SunderWorld world, SunderBody body,
                                                   uint64_t user_data);
/// Sets what the body and its pieces collide with.
SUNDER_API SunderResult sunder_world_set_filter(SunderWorld world, SunderBody body,
                                                SunderFilter filter);
/// Reports hits of at least this closing speed, in m/s, from the next step on; infinity: none.
SUNDER_API SunderResult sunder_world_report_hits(SunderWorld world, double least_m_s);

// ---------------------------------------------------------------------------------------------
// Ask. A function that fills an array of the caller's has a `count`: on input the number of
// elements that there is room for, on output the number that there are. If the room is too little,
// it returns SUNDER_ERROR_ARGUMENT, sets `count` to the number needed, and fills nothing. With a
// null array it returns SUNDER_OK and only sets `count`.
// ---------------------------------------------------------------------------------------------

/// Tells the time in seconds since the world was made.
SUNDER_API SunderResult sunder_world_time(SunderWorld world, double* time_s);

/// Tells whether a body is in the world.
SUNDER_API SunderResult sunder_world_contains_body(SunderWorld world, SunderBody body, bool* is_in);
/// Tells whether a joint is in the world.
SUNDER_API SunderResult sunder_world_contains_joint(SunderWorld world, SunderJoint joint,
                                                    bool* is_in);
/// Tells the number of bodies, without the ground.
SUNDER_API SunderResult sunder_world_body_count(SunderWorld world, uint32_t* count);

/// A body at present.
typedef struct SunderBodyInfo {
  SunderBody body;
  SunderBody root;  ///< The solid or ball that it was part of.
  SunderMotion motion;
  SunderVec3 com_W;  ///< Centre of mass.
  double mass_kg;
  double volume_m3;
  uint32_t convexes;  ///< 0 for a ball.
  bool is_static;     ///< It is anchored, or follows a path.
  bool is_kinematic;  ///< It follows a path.
  bool asleep;
  uint64_t user_data;
  SunderFilter filter;
  char name[SUNDER_NAME_SIZE];  ///< That of its root; may be empty.
} SunderBodyInfo;
/// Describes a body.
SUNDER_API SunderResult sunder_world_body(SunderWorld world, SunderBody body, SunderBodyInfo* info);

/// Arrays of the caller's for all bodies, ascending by key; null arrays are not filled. Positions
/// are those of the centres of mass.
typedef struct SunderBodyArrays {
  SunderBody* body;
  SunderVec3* position_W;
  SunderQuat* rotation_W;
  SunderVec3* velocity_W;
  SunderVec3* angular_velocity_W;
  uint8_t* is_static;  ///< 1 or 0.
  uint8_t* asleep;     ///< 1 or 0.
} SunderBodyArrays;
/// Copies the bodies into arrays, each of which has room for `*count` elements. A null `arrays`
/// only sets `count`.
SUNDER_API SunderResult sunder_world_bodies(SunderWorld world, const SunderBodyArrays* arrays,
                                            uint32_t* count);

/// Selects the bodies that a query can find.
typedef struct SunderQuery {
  uint32_t cookie;     ///< Set by sunder_default_query().
  uint32_t mask;       ///< A body is found if its filter's category has a bit in this mask.
  bool ground;         ///< False: the ground is not found.
  SunderBody ignored;  ///< A body that is not found, such as one that casts; SUNDER_NO_KEY: none.
  /// Called for bodies that the query meets, once or more for each, by the thread that asks; a body
  /// for which it returns false is not found. Null: all are found. It must not throw. It may ask
  /// the world; functions that change the world return SUNDER_ERROR_ARGUMENT. `accepts_user` is
  /// passed on.
  bool (*accepts)(SunderBody body, void* accepts_user);
  void* accepts_user;
} SunderQuery;

/// Returns a query that finds everything.
SUNDER_API SunderQuery sunder_default_query(void);

/// A point that a ray or a moving ball meets first on a body.
typedef struct SunderCastHit {
  SunderBody body;          ///< SUNDER_NO_KEY: the ground.
  uint32_t slot;            ///< Slot of the convex; 0 for a ball.
  SunderMaterial material;  ///< SUNDER_NO_MATERIAL for the plane of the ground.
  double distance_m;        ///< Along the ray, from its start; 0 if it starts inside.
  SunderVec3 point_W;
  SunderVec3 normal_W;  ///< Unit, out of the body; against the ray if it starts inside.
} SunderCastHit;

/// Finds the first point on the way from `from_W` along `direction_W` (of any length above 0) up to
/// `most_m`, which a ray, or a ball of a radius above 0, meets. `found` tells if there is one; else
/// `hit` is unchanged. A null query finds everything.
SUNDER_API SunderResult sunder_world_cast(SunderWorld world, SunderVec3 from_W,
                                          SunderVec3 direction_W, double most_m, double radius_m,
                                          const SunderQuery* query, SunderCastHit* hit,
                                          bool* found);
/// Finds all convexes and balls that the ray, or the ball, meets, by distance.
SUNDER_API SunderResult sunder_world_cast_all(SunderWorld world, SunderVec3 from_W,
                                              SunderVec3 direction_W, double most_m,
                                              double radius_m, const SunderQuery* query,
                                              SunderCastHit* hits, uint32_t* count);

/// A convex or ball that overlaps a volume.
typedef struct SunderOverlap {
  SunderBody body;  ///< SUNDER_NO_KEY: the ground.
  uint32_t slot;    ///< Slot of the convex; 0 for a ball.
} SunderOverlap;
/// Finds what overlaps a ball, sorted by body and slot.
SUNDER_API SunderResult sunder_world_overlap_ball(SunderWorld world, SunderVec3 center_W,
                                                  double radius_m, const SunderQuery* query,
                                                  SunderOverlap* overlaps, uint32_t* count);
/// Finds what overlaps a box along the axes of the world, sorted by body and slot.
SUNDER_API SunderResult sunder_world_overlap_box(SunderWorld world, SunderVec3 min_W,
                                                 SunderVec3 max_W, const SunderQuery* query,
                                                 SunderOverlap* overlaps, uint32_t* count);

/// A point where a body touches another.
typedef struct SunderContact {
  SunderBody other;  ///< SUNDER_NO_KEY: the ground.
  SunderVec3 point_W;
  SunderVec3 force_W;  ///< On the body, in N, friction included; at the end of the last step.
} SunderContact;
/// Finds the contacts of a body that carry load.
SUNDER_API SunderResult sunder_world_contacts(SunderWorld world, SunderBody body,
                                              SunderContact* contacts, uint32_t* count);

/// A body broke or cracked in the last step. A body may have been created and broken in it: then no
/// body has had its key at the end of a step.
typedef struct SunderBreak {
  double time_s;
  SunderBody parent;           ///< The body that broke; a static remainder keeps its key.
  const SunderBody* children;  ///< The bodies that it became.
  uint32_t child_count;
  uint32_t pieces;  ///< All pieces; those without a body became debris. 1: it only cracked.
  SunderMaterial material;
  SunderVec3 point_W;
  double energy_J;     ///< Energy taken from the impact.
  double new_area_m2;  ///< Area of the cracks.
} SunderBreak;

/// Two bodies that met in the last step, where they closed fastest.
typedef struct SunderHit {
  SunderBody a, b;  ///< b may be the ground, SUNDER_NO_KEY. Either may have broken in the step.
  SunderVec3 point_W;
  SunderVec3 normal_W;  ///< Unit, from a to b.
  double speed_m_s;     ///< Closing speed along the normal.
  double mass_kg;       ///< Effective mass along the normal: the energy is mass · speed² / 2.
} SunderHit;

/// Changes during the last step, and between it and the step before.
typedef struct SunderEvents {
  const SunderBreak* breaks;
  uint32_t break_count;
  const SunderHit* hits;  ///< If requested by sunder_world_report_hits(); sorted by keys.
  uint32_t hit_count;
  // Ascending. A body that appeared and broke within the step is in none of these.
  const SunderBody* appeared;
  uint32_t appeared_count;
  const SunderBody* gone;
  uint32_t gone_count;
  const SunderBody* fell_asleep;
  uint32_t fell_asleep_count;
  const SunderBody* woke;
  uint32_t woke_count;
  const SunderJoint* joints_lost;
  uint32_t joints_lost_count;
} SunderEvents;
/// Tells what happened in the last step. The arrays are valid until the next step of this world,
/// or until it is destroyed; those without elements are null.
SUNDER_API SunderResult sunder_world_events(SunderWorld world, SunderEvents* events);

/// Stages of a step, in order; indices of the times in a report.
enum {
  SUNDER_STAGE_ACT = 0,
  SUNDER_STAGE_COLLIDE = 1,
  SUNDER_STAGE_BREAK = 2,
  SUNDER_STAGE_SOLVE = 3,
  SUNDER_STAGE_LOAD = 4,
  SUNDER_STAGE_PARTICLES = 5,
  SUNDER_STAGE_SNAPSHOT = 6,
  SUNDER_STAGES = 7
};

/// Figures of the last step.
typedef struct SunderReport {
  double stage_ms[SUNDER_STAGES];      ///< Wall time.
  double stage_cpu_ms[SUNDER_STAGES];  ///< Processor time of all threads.
  uint32_t moving_bodies;
  uint32_t awake_bodies;
  uint32_t convexes;
  uint32_t contacts;
  double mass_kg;  ///< With debris, bodies removed and shots yet to come.
  double volume_m3;
  double kinetic_J;
  double potential_J;
  double plastic_J;
  double energy_residual_J;  ///< Change of the kinetic energy that no cause accounts for.
  double momentum_residual;  ///< Share of the momentum exchanged that no force accounts for.
  uint32_t carried_over;     ///< Impacts and loads deferred to a later step by the budget.
  uint32_t failed;           ///< Convexes that a break left whole because of a failed cut.
  uint32_t limits_hit;       ///< How often limits of the scene were reached.
  uint32_t aged;             ///< Fragments turned into debris to keep within limits.
  uint32_t joints_lost;
} SunderReport;
/// Tells figures of the last step.
SUNDER_API SunderResult sunder_world_report(SunderWorld world, SunderReport* report);

/// Computes the hash of the present state: poses, velocities and flags of all bodies, debris and
/// dust. Equal hashes, equal states. It takes a frame, as sunder_world_frame() does.
SUNDER_API SunderResult sunder_world_state_hash(SunderWorld world, uint64_t* hash);
/// Computes the hash of a run from the hashes of its states: of the states at the start and after
/// each step of 1/60 s, it is the "state hash" of `sunder simulate` for the same scene. Writes 16
/// hexadecimal digits and a null.
SUNDER_API SunderResult sunder_run_hash(const uint64_t* state_hashes, uint32_t count, char hex[17]);

// ---------------------------------------------------------------------------------------------
// Draw
// ---------------------------------------------------------------------------------------------

/// A mesh drawn at a pose. A program uploads each mesh once: an index never changes its meaning.
typedef struct SunderInstance {
  uint32_t mesh;            ///< Index for sunder_world_mesh().
  SunderBody body;          ///< SUNDER_NO_KEY: the ground.
  SunderMaterial material;  ///< Material to draw it with.
  SunderPose X_WM;          ///< Pose of the mesh: world = X_WM · position of a vertex.
} SunderInstance;

/// A piece of debris, inscribed in a sphere.
typedef struct SunderDebris {
  float position_W[3];
  float rotation[4];  ///< x, y, z, w.
  float radius_m;
  SunderMaterial material;
} SunderDebris;

/// A puff of dust.
typedef struct SunderDust {
  float position_W[3];
  float radius_m;
  float opacity;  ///< 0 to 1.
  SunderMaterial material;
} SunderDust;

/// The meshes and particles to draw at present.
typedef struct SunderFrame {
  uint64_t index;
  double time_s;
  const SunderInstance* instances;
  uint32_t instance_count;
  const SunderDebris* debris;
  uint32_t debris_count;
  const SunderDust* dust;
  uint32_t dust_count;
  uint32_t mesh_count;        ///< Meshes have indices below this.
  uint32_t appearance_count;  ///< Appearances have indices below this.
} SunderFrame;

/// Appearance of a vertex.
enum {
  SUNDER_LOOK_SURFACE = 0,   ///< The material's surface.
  SUNDER_LOOK_INTERIOR = 1,  ///< The material's interior: a face that a break made.
  /// From here on: an appearance of the mesh file; sunder_world_appearance() has it by the index
  /// `look` - SUNDER_LOOK_FILE.
  SUNDER_LOOK_FILE = 2
};

/// A vertex of a mesh.
typedef struct SunderVertex {
  float position[3];  ///< In the frame of the mesh, in m.
  float normal[3];    ///< Unit.
  uint32_t look;      ///< SUNDER_LOOK_...
} SunderVertex;

/// Vertices and triangles of one convex or ball.
typedef struct SunderMesh {
  const SunderVertex* vertices;
  uint32_t vertex_count;
  const uint32_t* indices;  ///< Three for each triangle, counter-clockwise seen from outside.
  uint32_t index_count;
  SunderMaterial material;
  /// Texture coordinates u and v of each vertex, also of faces that a break made; null if no
  /// texture needs them.
  const float* uvs;
} SunderMesh;

/// An image as the bytes of its PNG or JPEG file, repeated beyond its edges.
typedef struct SunderImage {
  const void* bytes;  ///< Null: there is none.
  size_t size;        ///< Number of bytes.
} SunderImage;

/// The appearance of a face as its mesh file defines it, with parameters as in glTF.
typedef struct SunderAppearance {
  float color[3];       ///< Linear RGB, multiplied by `picture`.
  SunderImage picture;  ///< Base colour texture.
  bool v_from_bottom;   ///< True: v = 0 is the bottom row of an image (OBJ); false: the top (glTF).
  SunderImage relief;   ///< Normal map, or a bump map if it is grey.
  float normal_scale;   ///< Factor on the slopes of `relief`.
  bool has_gloss;       ///< False: diffuse colour only.
  float roughness;      ///< 0 (mirror) to 1 (rough).
  float metallic;       ///< 0 (dielectric) to 1 (metal).
  SunderImage gloss;    ///< Green scales roughness, blue scales metallic.
} SunderAppearance;

/// Tells what there is to draw. The arrays, and those of meshes, are valid until the next call of
/// sunder_world_frame() for this world, or until it is destroyed; those without elements are null.
SUNDER_API SunderResult sunder_world_frame(SunderWorld world, SunderFrame* frame);
/// Tells the vertices and triangles of a mesh of the last frame of sunder_world_frame().
/// SUNDER_ERROR_ARGUMENT if there is no frame or no such mesh, or if no body is drawn with it.
SUNDER_API SunderResult sunder_world_mesh(SunderWorld world, uint32_t mesh, SunderMesh* out);
/// Describes an appearance of the last frame of sunder_world_frame(), whose images are valid as
/// long as its arrays. SUNDER_ERROR_ARGUMENT if there is no frame or no such appearance.
SUNDER_API SunderResult sunder_world_appearance(SunderWorld world, uint32_t index,
                                                SunderAppearance* appearance);

#ifdef __cplusplus
}
#endif
