// The whole public interface of Sunder as a library: make a world, act on it and ask it; or make a
// simulation of a scene, and pump its frames into sinks.
//
//   #include <sunder/sunder.h>
//
//   const auto simulation = sunder::scenes::make_simulation(sunder::scenes::load_scene("house"));
//   const auto video = sunder::render::make_picture_sink("house.mp4", {});
//   sunder::StateHash hash;
//   sunder::FrameSink* const sinks[] = {video.get(), &hash};
//   sunder::pump(*simulation, sinks);
//
// Read next: world.h for a running world, scene.h for the input, frame.h for the output.
#pragma once

#include "engine/base/check.h"                  // InputError, FileError
#include "engine/base/types.h"                  // Vec3, Quat, Pose, Box
#include "engine/geometry/convex_polyhedron.h"  // make_box(), make_prism()
#include "engine/geometry/hull.h"               // make_hull()
#include "engine/io/recording/recording.h"      // RecordingWriter, RecordingReader
#include "engine/io/state_hash.h"               // hash_state()
#include "engine/io/statistics.h"               // Statistics, StateHash
#include "engine/model/collision_filter.h"
#include "engine/model/compound.h"  // Part, Compound
#include "engine/model/frame.h"     // Frame, FrameSource, FrameSink, pump()
#include "engine/model/joint.h"
#include "engine/model/material.h"
#include "engine/model/scene.h"
#include "engine/world/world.h"         // World, Asset
#include "render/image/image.h"         // Image, write_png()
#include "render/renderer.h"            // Renderer
#include "render/sinks.h"               // make_picture_sink()
#include "scenes/file/make_compound.h"  // make_compound() of parts, or of a mesh
#include "scenes/load.h"                // load_scene(), builtin_materials()
#include "scenes/make_simulation.h"
