// Frames, the meshes that they draw, hashes of states, and recordings.
#include <optional>

#include "engine/base/check.h"
#include "engine/io/recording/recording.h"
#include "engine/io/statistics.h"
#include "scenes/api/python/bindings.h"

namespace sunder::python {
namespace {

/// A mesh of a frame in Python.
struct SharedMesh {
  std::shared_ptr<const Mesh> mesh;
};

/// The bodies of a frame, as views of its array.
struct FrameBodies {
  FramePtr frame;

  template <class Value, class Member>
  py::array column(Member member, py::ssize_t width = 0) const {
    const std::vector<FrameBody>& bodies = frame->bodies;
    static const FrameBody none;
    const FrameBody& first = bodies.empty() ? none : bodies.front();
    return column_of<Value>(frame, bodies, member(first), width);
  }
};

/// Returns the vertices of an instance in the world.
py::array world_vertices(const Frame& frame, std::size_t instance) {
  if (instance >= frame.instances.size()) {
    throw InputError("there is no instance " + std::to_string(instance) + "; the frame has " +
                     std::to_string(frame.instances.size()));
  }
  const Instance& drawn = frame.instances[instance];
  const Mesh& mesh = *(*frame.meshes)[drawn.mesh.value];
  const FrameBody& body = frame.bodies[drawn.body];
  py::array_t<double> points({static_cast<py::ssize_t>(mesh.vertices.size()), py::ssize_t{3}});
  auto rows = points.mutable_unchecked<2>();
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3 point_T = mesh.origin_T + mesh.vertices[i].position.cast<double>();
    const Vec3 point_W = body.X_WB * Vec3(mesh.X_RT * point_T - body.com_R);
    for (int axis = 0; axis < 3; ++axis) rows(static_cast<py::ssize_t>(i), axis) = point_W[axis];
  }
  return points;
}

SharedMesh mesh_at(const Frame& frame, std::size_t index) {
  const std::size_t count = frame.meshes ? frame.meshes->size() : 0;
  if (index >= count || !(*frame.meshes)[index]) {
    throw InputError("there is no mesh " + std::to_string(index) +
                     " in the frame; expected the first element of a row of `instances`");
  }
  return {(*frame.meshes)[index]};
}

void bind_meshes(py::module_& module) {
  py::class_<SharedMesh>(module, "Mesh",
                         "Triangles of one convex or ball, as views of the frame's own arrays.")
      .def_property_readonly(
          "vertices",
          [](const SharedMesh& self) {
            const Mesh& mesh = *self.mesh;
            return column_of<float>(self.mesh, mesh.vertices, mesh.vertices.data()->position.data(),
                                    3);
          },
          "Positions (n, 3), float32, relative to `origin`.")
      .def_property_readonly(
          "normals",
          [](const SharedMesh& self) {
            const Mesh& mesh = *self.mesh;
            return column_of<float>(self.mesh, mesh.vertices, mesh.vertices.data()->normal.data(),
                                    3);
          },
          "Unit normals (n, 3), float32.")
      .def_property_readonly(
          "looks",
          [](const SharedMesh& self) {
            const Mesh& mesh = *self.mesh;
            return column_of<std::uint32_t>(self.mesh, mesh.vertices, &mesh.vertices.data()->look);
          },
          "Appearance of each vertex (n), uint32: 0 on the original surface, 1 on faces that a "
          "break made.")
      .def_property_readonly(
          "indices",
          [](const SharedMesh& self) {
            const Mesh& mesh = *self.mesh;
            const auto count = static_cast<py::ssize_t>(mesh.indices.size() / 3);
            return view_of(self.mesh, py::dtype::of<std::uint32_t>(), mesh.indices.data(),
                           {count, 3}, {12, 4});
          },
          "Vertices of triangles (m, 3), uint32, counter-clockwise seen from outside.")
      .def_property_readonly(
          "origin", [](const SharedMesh& self) { return self.mesh->origin_T; },
          "Point that vertices are relative to.")
      .def_property_readonly(
          "material", [](const SharedMesh& self) { return self.mesh->material.value; },
          "Index of the material.");
}

void bind_frame_bodies(py::module_& module) {
  py::class_<FrameBodies>(
      module, "FrameBodies",
      "The bodies of a frame, ascending by key, as read-only views that keep the frame alive.")
      .def("__len__", [](const FrameBodies& self) { return self.frame->bodies.size(); })
      .def_property_readonly(
          "keys",
          [](const FrameBodies& self) {
            return self.column<std::uint64_t>([](const FrameBody& body) { return &body.key; });
          },
          "Keys (n), uint64.")
      .def_property_readonly(
          "previous_keys",
          [](const FrameBodies& self) {
            return self.column<std::uint64_t>(
                [](const FrameBody& body) { return &body.previous_key; });
          },
          "Key of the body that each was part of in the previous frame (n), uint64.")
      .def_property_readonly(
          "positions",
          [](const FrameBodies& self) {
            return self.column<double>(
                [](const FrameBody& body) { return body.X_WB.position.data(); }, 3);
          },
          "Centres of mass (n, 3), float64.")
      .def_property_readonly(
          "rotations",
          [](const FrameBodies& self) {
            return self.column<double>(
                [](const FrameBody& body) { return body.X_WB.rotation.coeffs().data(); }, 4);
          },
          "Quaternions (n, 4), float64, in the order x, y, z, w.")
      .def_property_readonly(
          "centers",
          [](const FrameBodies& self) {
            return self.column<double>([](const FrameBody& body) { return body.com_R.data(); }, 3);
          },
          "Centres of mass in the frame that each solid was modelled in (n, 3), float64.")
      .def_property_readonly(
          "velocities",
          [](const FrameBodies& self) {
            return self.column<double>([](const FrameBody& body) { return body.velocity_W.data(); },
                                       3);
          },
          "Velocities of the centres of mass (n, 3), float64, in m/s.")
      .def_property_readonly(
          "angular_velocities",
          [](const FrameBodies& self) {
            return self.column<double>(
                [](const FrameBody& body) { return body.angular_velocity_W.data(); }, 3);
          },
          "Angular velocities (n, 3), float64, in rad/s.")
      .def_property_readonly(
          "masses_kg",
          [](const FrameBodies& self) {
            return self.column<double>([](const FrameBody& body) { return &body.mass_kg; });
          },
          "Masses (n), float64; 0 in frames of a recording.")
      .def_property_readonly(
          "is_static",
          [](const FrameBodies& self) {
            return self.column<bool>([](const FrameBody& body) { return &body.is_static; });
          },
          "True for anchored bodies and those on a path (n), bool.")
      .def_property_readonly(
          "asleep",
          [](const FrameBodies& self) {
            return self.column<bool>([](const FrameBody& body) { return &body.asleep; });
          },
          "True for bodies at rest that are not simulated (n), bool.");
}

void bind_breaks(py::module_& module) {
  py::class_<BreakEvent>(module, "Break", "A body broke or cracked.")
      .def_readonly("time_s", &BreakEvent::time_s, "Time in s.")
      .def_readonly("parent", &BreakEvent::parent_key, "Key of the body that broke.")
      .def_readonly("children", &BreakEvent::child_keys,
                    "Keys of its pieces; a static remainder keeps the key of the parent.")
      .def_property_readonly(
          "material", [](const BreakEvent& self) { return self.material.value; },
          "Index of the material at the point of the break.")
      .def_readonly("point", &BreakEvent::point_W, "Point of impact, or of the highest stress.")
      .def_readonly("energy_J", &BreakEvent::energy_J, "Energy taken from the impact.")
      .def_readonly("new_area_m2", &BreakEvent::new_area_m2, "New crack area.")
      .def_readonly("pieces", &BreakEvent::pieces,
                    "Number of all pieces, those that became debris included; 1: only cracked.");
}

/// A recording in Python, which one thread uses at a time.
struct Recording {
  explicit Recording(const std::filesystem::path& path) : reader(path) {}

  FramePtr next() {
    const Use use(is_used);
    const py::gil_scoped_release release;
    return reader.next();
  }

  RecordingReader reader;
  bool is_used = false;
};

/// A recording that is being written.
struct Recorder {
  explicit Recorder(const std::filesystem::path& path) : writer(std::in_place, path) {}

  void take(const SharedFrame& frame) {
    if (!writer) throw InputError("the recording is closed");
    writer->take(frame.frame);
  }
  void close() {
    if (!writer) return;
    {
      const py::gil_scoped_release release;
      writer->finish();
    }
    writer.reset();
  }

  std::optional<RecordingWriter> writer;
};

}  // namespace

void bind_frames(py::module_& module) {
  bind_breaks(module);
  bind_meshes(module);
  bind_frame_bodies(module);
  py::class_<SharedFrame>(
      module, "Frame",
      "All that is drawn and reported at one instant; it never changes. Arrays are read-only views "
      "that keep the frame alive.")
      .def_property_readonly(
          "index", [](const SharedFrame& self) { return self.frame->index; }, "Number from 0 on.")
      .def_property_readonly(
          "time_s", [](const SharedFrame& self) { return self.frame->time_s; }, "Time in s.")
      .def_property_readonly(
          "bodies", [](const SharedFrame& self) { return FrameBodies{self.frame}; }, "The bodies.")
      .def_property_readonly(
          "instances",
          [](const SharedFrame& self) {
            return rows_of<std::uint32_t>(self.frame, self.frame->instances, 3);
          },
          "What is drawn (n, 3), uint32: the index of the mesh for mesh(), the place of the body "
          "in "
          "`bodies`, and the material, 0xffffffff for that of the mesh.")
      .def(
          "mesh",
          [](const SharedFrame& self, std::size_t index) { return mesh_at(*self.frame, index); },
          py::arg("index"), "Returns a mesh by its index in `instances`.")
      .def(
          "world_vertices",
          [](const SharedFrame& self, std::size_t instance) {
            return world_vertices(*self.frame, instance);
          },
          py::arg("instance"),
          "Returns the vertices of a row of `instances` in the world (n, 3), float64: a copy.")
      .def_property_readonly(
          "debris_positions",
          [](const SharedFrame& self) {
            const std::vector<FrameDebris>& debris = self.frame->debris;
            return column_of<float>(self.frame, debris, debris.data()->position_W.data(), 3);
          },
          "Positions of debris (n, 3), float32.")
      .def_property_readonly(
          "debris_radii_m",
          [](const SharedFrame& self) {
            const std::vector<FrameDebris>& debris = self.frame->debris;
            return column_of<float>(self.frame, debris, &debris.data()->radius_m);
          },
          "Radii of debris (n), float32.")
      .def_property_readonly(
          "dust_positions",
          [](const SharedFrame& self) {
            const std::vector<FrameDust>& dust = self.frame->dust;
            return column_of<float>(self.frame, dust, dust.data()->position_W.data(), 3);
          },
          "Positions of dust (n, 3), float32.")
      .def_property_readonly(
          "breaks", [](const SharedFrame& self) { return self.frame->breaks; },
          "Breaks since the previous frame.")
      .def_property_readonly(
          "report", [](const SharedFrame& self) { return dict_of(self.frame->report); },
          "Counts, times and sums of the frame, with the names of the program's JSON.")
      .def_property_readonly(
          "materials",
          [](const SharedFrame& self) {
            return self.frame->materials ? names_of(*self.frame->materials)
                                         : std::vector<std::string>();
          },
          "Names of the materials by index.")
      .def(
          "state_hash", [](const SharedFrame& self) { return hash_of(self.frame); },
          "Returns 16 hexadecimal digits: equal digits, equal states.")
      .def("__repr__", [](const SharedFrame& self) {
        return "<Frame " + std::to_string(self.frame->index) + " of " +
               std::to_string(self.frame->bodies.size()) + " bodies>";
      });

  py::class_<StateHash>(module, "StateHash",
                        "A hash of the states of a run: that of the program, if it takes the frame "
                        "at the start and one every 1/60 s.")
      .def(py::init(), "Makes the hash of no frames.")
      .def(
          "take", [](StateHash& self, const SharedFrame& frame) { self.take(frame.frame); },
          py::arg("frame"), "Adds the state of a frame.")
      .def(
          "hex", [](const StateHash& self) { return self.hex(); },
          "Returns 16 hexadecimal digits over all frames.");
}

void bind_recordings(py::module_& module) {
  py::class_<Recording>(module, "Recording", "An iterator over the frames of a recording.")
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__",
           [](Recording& self) {
             FramePtr frame = self.next();
             if (!frame) throw py::stop_iteration();
             return SharedFrame{std::move(frame)};
           })
      .def("__len__", [](const Recording& self) { return self.reader.frames(); })
      .def(
          "seek",
          [](Recording& self, std::uint32_t frame) {
            const Use use(self.is_used);
            self.reader.seek(frame);
          },
          py::arg("frame"), "Sets the frame that comes next, from 0 on.")
      .def_property_readonly(
          "damage", [](const Recording& self) { return self.reader.damage(); },
          "Description of the damage found so far; empty if there is none.")
      .def_property_readonly(
          "is_complete", [](const Recording& self) { return self.reader.is_complete(); },
          "True if the run finished.");
  module.def(
      "read_recording",
      [](const std::filesystem::path& file) { return std::make_unique<Recording>(file); },
      py::arg("file"), "Opens a recording (.take); iterating over it gives its frames.");

  py::class_<Recorder>(module, "Recorder",
                       "Writes frames to a recording (.take); a context manager that closes it.")
      .def(py::init<const std::filesystem::path&>(), py::arg("file"), "Creates the file.")
      .def("take", &Recorder::take, py::arg("frame"), "Adds a frame.")
      .def("close", &Recorder::close, "Writes what is left, and closes the file.")
      .def("__enter__", [](py::object self) { return self; })
      .def("__exit__", [](Recorder& self, const py::args&) { self.close(); });
}

}  // namespace sunder::python
