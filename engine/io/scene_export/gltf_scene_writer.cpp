// Begin with take() and finish().
#include "engine/io/scene_export/gltf_scene_writer.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <span>
#include <unordered_set>

#include <nlohmann/json.hpp>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/io/bytes.h"
#include "engine/io/mesh/gltf_material_writer.h"
#include "engine/io/scene_export/body_tracks.h"
#include "engine/io/scene_export/chip_nodes.h"
#include "engine/io/scene_export/gltf_buffers.h"
#include "engine/io/scene_export/run_materials.h"
#include "engine/io/scene_export/side_data.h"
#include "engine/io/unfinished_file.h"

namespace sunder {
namespace {

using nlohmann::json;
using Accessor = GltfBuffers::Accessor;

constexpr double kRadians = 0.017453292519943295;  // of a degree
constexpr std::size_t kMeshesAChunk = 16;

// Constants of the format.
constexpr std::uint32_t kMagic = 0x46546c67, kJson = 0x4e4f534a, kBinary = 0x004e4942;
constexpr std::uint64_t kMaxBytes = 0xffffffff;

/// Times and values of a track.
struct Track {
  Accessor times = 0, values = 0;
};

/// The tracks and side data of a body that is gone.
struct BodyRecord {
  std::uint64_t key = 0, parent_key = 0;
  std::uint32_t name = kNoName;
  double mass_kg = 0;
  std::uint32_t born = 0, gone = kUntilEnd;
  Vec3 center_R = Vec3::Zero();
  Vec3f position = Vec3f::Zero();  ///< When it appears.
  RotationKeys::Key rotation = {};
  std::optional<Track> positions, rotations;  ///< None: constant.
  std::vector<InstanceSpan> spans;
};

/// A mesh of the store in the document.
struct MeshRecord {
  Pose X_RT;
  Vec3 center_T = Vec3::Zero();
  double half_m = 1;
  MaterialIndex material;
  std::vector<std::uint32_t> looks;  ///< For each element of accessors.indices.
  GltfBuffers::MeshAccessors accessors;
};

/// Elements of a JSON list, in text.
class JsonList {
 public:
  /// Begins the next element, and returns its number.
  std::size_t begin() {
    if (count_ > 0) out << ",\n";
    return count_++;
  }
  std::size_t size() const { return count_; }
  TextWriter out{","};

 private:
  std::size_t count_ = 0;
};

/// Returns the rotation of a camera or lamp, which look along -Z of their node.
Quat looking_along(const Vec3& direction) {
  const Vec3 back = -direction.normalized();
  const Vec3 up = std::abs(back.y()) < 0.999 ? Vec3::UnitY() : Vec3::UnitZ();
  const Vec3 right = up.cross(back).normalized();
  Mat3 axes;
  axes << right, back.cross(right), back;
  return Quat(axes).normalized();
}

Eigen::Vector4f as_vector(const Quat& rotation) { return rotation.coeffs().cast<float>(); }

}  // namespace

/// A document being made; implements the members of GltfSceneWriter.
class GltfSceneWriter::Scene {
 public:
  Scene(const std::filesystem::path& path, const GltfSceneOptions& options);
  void take(const FramePtr& frame);
  void finish();
  GltfSceneFigures figures;

 private:
  // Frames.
  void add_meshes(const Frame& frame);
  void add_mesh(MeshIndex index, const Mesh& mesh, const QuantizedMesh& quantized);
  void add_view(const View& view);
  void store(const BodyTrack& track);
  template <class Motion>
  std::optional<Track> store(const KeyReducer<Motion>& keys);

  // The document.
  void describe_camera_and_sun();
  void describe_ground();
  std::size_t describe_chip_mesh(MaterialIndex material);
  void describe_chips();
  void describe_bodies();
  void describe_body(const BodyRecord& body, const std::string& name);
  std::string name_of_node(const BodyRecord& body);
  std::size_t describe_group(std::vector<InstanceSpan>::const_iterator begin,
                             std::vector<InstanceSpan>::const_iterator end, const BodyRecord& body);
  std::size_t describe_instance(const InstanceSpan& span, const BodyRecord& body);
  std::size_t mesh_number(const InstanceSpan& span);
  std::size_t used_material(std::size_t index);
  void animate(std::size_t node, const char* path, const Track& track, bool is_step);
  void animate_visibility(std::size_t node, std::uint32_t begin, std::uint32_t end);
  std::string document();
  std::string extras() const;
  json describe_materials();
  void write(const std::string& text);
  void write_parts(const std::filesystem::path& place, const std::string& text,
                   std::uint64_t binary);

  std::filesystem::path path_;
  GltfSceneOptions options_;
  GltfBuffers buffers_;
  BodyTracks tracks_;
  KeyReducer<PositionKeys> eye_;
  KeyReducer<RotationKeys> gaze_;
  SideData side_data_;
  FramePtr first_;           ///< Frame 0, for what does not change: without bodies and meshes.
  std::uint64_t frame_ = 0;  ///< Number of the next frame of the source.
  std::uint32_t next_ = 0;   ///< Number of the next frame of the file.
  Box places_W_;             ///< Of the bodies in all frames.
  std::vector<std::int32_t> record_of_mesh_;  ///< By MeshIndex; -1: none yet.
  std::vector<MeshRecord> meshes_;
  std::vector<BodyRecord> bodies_;
  std::vector<ChipFrame> chips_;

  std::vector<Model::Material> materials_;   ///< That the document may use, materials_of_run().
  std::vector<std::size_t> used_materials_;  ///< Indices in `materials_`, in the document's order.
  std::optional<GltfBuffers::MeshAccessors> chip_;
  GltfMaterialWriter material_writer_;
  JsonList nodes_, mesh_list_, channels_, samplers_;
  std::vector<std::size_t> roots_;  ///< Nodes of the scene.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> mesh_numbers_;
  std::map<std::vector<int>, Accessor> visibilities_;  ///< Accessors of lists of scales.
  std::unordered_set<std::string> names_;              ///< Names of nodes.
};

GltfSceneWriter::Scene::Scene(const std::filesystem::path& path, const GltfSceneOptions& options)
    : path_(path),
      options_(options),
      buffers_(path, options.frames_per_s),
      tracks_(PositionKeys(options.tolerance_m), RotationKeys(options.tolerance_deg * kRadians),
              [this](const BodyTrack& track) { store(track); }),
      eye_(PositionKeys(options.tolerance_m)),
      gaze_(RotationKeys(options.tolerance_deg * kRadians)) {
  SUNDER_CHECK(options.frames_per_s > 0 && 60 % options.frames_per_s == 0);
}

void GltfSceneWriter::Scene::take(const FramePtr& frame) {
  side_data_.add_breaks(*frame);
  if (frame_++ % static_cast<std::uint64_t>(60 / options_.frames_per_s) != 0)
    return tracks_.skip(*frame);
  if (!first_) {
    auto first = std::make_shared<Frame>();
    first->view = frame->view;
    first->materials = frame->materials;
    first->appearances = frame->appearances;
    first->names = frame->names;
    first_ = first;
    materials_ = materials_of_run(*frame);
  }
  side_data_.add_times(*frame);
  add_meshes(*frame);
  add_view(frame->view);
  for (const FrameBody& body : frame->bodies) places_W_.extend(body.X_WB.position);
  figures.samples += frame->bodies.size();
  tracks_.add(next_, *frame);
  const int chip_step = std::max(1, options_.frames_per_s / kChipFramesPerSecond);
  if (options_.particles && next_ % static_cast<std::uint32_t>(chip_step) == 0) {
    figures.chips += frame->debris.size();
    chips_.push_back(add_chips(next_, frame->debris, buffers_));
  }
  ++next_;
}

/// Adds the meshes that the frame is the first to draw.
void GltfSceneWriter::Scene::add_meshes(const Frame& frame) {
  record_of_mesh_.resize(std::max(record_of_mesh_.size(), frame.meshes->size()), -1);
  std::vector<MeshIndex> added;
  for (const Instance& instance : frame.instances) {
    std::int32_t& record = record_of_mesh_[instance.mesh.value];
    if (record >= 0 || (*frame.meshes)[instance.mesh.value]->indices.empty()) continue;
    record = static_cast<std::int32_t>(meshes_.size() + added.size());
    added.push_back(instance.mesh);
  }
  std::vector<QuantizedMesh> quantized(added.size());
  std::span<const Appearance> appearances;
  if (frame.appearances) appearances = *frame.appearances;
  for_chunks(added.size(), kMeshesAChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i)
      quantized[i] = quantize(*(*frame.meshes)[added[i].value], appearances);
  });
  for (std::size_t i = 0; i < added.size(); ++i)
    add_mesh(added[i], *(*frame.meshes)[added[i].value], quantized[i]);
}

void GltfSceneWriter::Scene::add_mesh(MeshIndex index, const Mesh& mesh,
                                      const QuantizedMesh& quantized) {
  record_of_mesh_[index.value] = static_cast<std::int32_t>(meshes_.size());
  MeshRecord& record = meshes_.emplace_back();
  record.X_RT = mesh.X_RT;
  record.center_T = quantized.center_T;
  record.half_m = quantized.half_m;
  record.material = mesh.material;
  for (const QuantizedMesh::Part& part : quantized.parts) record.looks.push_back(part.look);
  record.accessors = buffers_.add_mesh(quantized);
}

void GltfSceneWriter::Scene::add_view(const View& view) {
  eye_.add(next_, view.eye_W);
  gaze_.add(next_, looking_along(view.target_W - view.eye_W));
}

void GltfSceneWriter::Scene::store(const BodyTrack& track) {
  figures.keys += track.positions.keys().size() + track.rotations.keys().size();
  bodies_.push_back({track.key, track.parent_key, track.name, track.mass_kg, track.born, track.gone,
                     track.center_R, track.positions.keys().front(), track.rotations.keys().front(),
                     store(track.positions), store(track.rotations), track.spans});
}

/// Writes the keys of a motion, unless it is constant.
template <class Motion>
std::optional<Track> GltfSceneWriter::Scene::store(const KeyReducer<Motion>& keys) {
  if (keys.keys().size() < 2) return std::nullopt;
  const Accessor times = buffers_.add_times(keys.frames());
  if constexpr (std::is_same_v<Motion, PositionKeys>) {
    return Track{times, buffers_.add_vectors(keys.keys())};
  } else {
    return Track{times, buffers_.add_rotations(keys.keys())};
  }
}

void GltfSceneWriter::Scene::finish() {
  if (next_ == 0) return;
  tracks_.finish();
  eye_.finish();
  gaze_.finish();
  write(document());
}

/// Adds a channel of the animation.
void GltfSceneWriter::Scene::animate(std::size_t node, const char* path, const Track& track,
                                     bool is_step) {
  channels_.begin();
  channels_.out << "{\"sampler\":" << samplers_.size() << ",\"target\":{\"node\":" << node
                << ",\"path\":\"" << path << "\"}}";
  samplers_.begin();
  samplers_.out << "{\"input\":" << track.times << ",\"output\":" << track.values
                << (is_step ? ",\"interpolation\":\"STEP\"}" : "}");
}

/// Shows a node from frame `begin` to the one before `end` alone, by its scale.
void GltfSceneWriter::Scene::animate_visibility(std::size_t node, std::uint32_t begin,
                                                std::uint32_t end) {
  std::vector<std::uint32_t> frames = {0};
  std::vector<int> scales = {begin == 0 ? 1 : 0};
  if (begin > 0) frames.push_back(begin), scales.push_back(1);
  if (end != kUntilEnd) frames.push_back(end), scales.push_back(0);
  if (frames.size() == 1) return;
  const auto [known, is_new] = visibilities_.try_emplace(scales);
  if (is_new) {
    std::vector<Vec3f> vectors;
    for (const int scale : scales) vectors.push_back(Vec3f::Constant(static_cast<float>(scale)));
    known->second = buffers_.add_vectors(vectors);
  }
  animate(node, "scale", {buffers_.add_times(frames), known->second}, true);
}

void GltfSceneWriter::Scene::describe_camera_and_sun() {
  const View& view = first_->view;
  const std::size_t camera = nodes_.begin();
  roots_.push_back(camera);
  nodes_.out << "{\"name\":\"camera\",\"camera\":0,\"translation\":[" << eye_.keys().front()
             << "],\"rotation\":[" << as_vector(looking_along(view.target_W - view.eye_W)) << "]}";
  if (const auto track = store(eye_)) animate(camera, "translation", *track, false);
  if (const auto track = store(gaze_)) animate(camera, "rotation", *track, false);
  roots_.push_back(nodes_.begin());
  nodes_.out << "{\"name\":\"sun\",\"rotation\":[" << as_vector(looking_along(-view.to_sun_W))
             << "],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}";
  names_.insert({"camera", "sun", "ground"});
}

/// Adds a square of the ground plane below all bodies.
void GltfSceneWriter::Scene::describe_ground() {
  constexpr double kMargin = 1.5, kLeastHalf_m = 10;
  Mesh square;
  for (const auto& [x, z] : {std::pair{-1.f, -1.f}, {-1.f, 1.f}, {1.f, 1.f}, {1.f, -1.f}})
    square.vertices.push_back({Vec3f(x, 0, z), Vec3f::UnitY(), Mesh::kSurface});
  square.indices = {0, 1, 2, 0, 2, 3};
  Box box = places_W_;
  if (box.empty()) box.extend(Vec3(Vec3::Zero()));
  const double half_m =
      std::max(kLeastHalf_m, kMargin * std::max(box.extent().x(), box.extent().z()));
  const Vec3 center(box.center().x(), first_->view.ground_m, box.center().z());
  const auto accessors = buffers_.add_mesh(quantize(square, {}));
  const std::size_t mesh = mesh_list_.begin();
  mesh_list_.out << "{\"primitives\":[{\"attributes\":{\"POSITION\":" << accessors.positions
                 << ",\"NORMAL\":" << accessors.normals << "},\"indices\":" << accessors.indices[0]
                 << ",\"material\":" << used_material(materials_.size() - 1) << "}]}";
  roots_.push_back(nodes_.begin());
  nodes_.out << "{\"name\":\"ground\",\"mesh\":" << mesh << ",\"translation\":["
             << Vec3f(center.cast<float>()) << "],\"scale\":["
             << Vec3f(Vec3f::Constant(static_cast<float>(half_m))) << "]}";
}

/// Adds a mesh for the debris of a material.
std::size_t GltfSceneWriter::Scene::describe_chip_mesh(MaterialIndex material) {
  if (!chip_) chip_ = buffers_.add_mesh(quantize(make_chip(), {}));
  const std::size_t number = mesh_list_.begin();
  mesh_list_.out << "{\"name\":\"debris\",\"primitives\":[{\"attributes\":{\"POSITION\":"
                 << chip_->positions << ",\"NORMAL\":" << chip_->normals
                 << "},\"indices\":" << chip_->indices[0] << ",\"material\":"
                 << used_material(material_of_look(Mesh::kInterior, material, *first_)) << "}]}";
  return number;
}

/// Adds a node for the debris of each material in each frame, below one that shows it in its time.
void GltfSceneWriter::Scene::describe_chips() {
  std::map<MaterialIndex, std::size_t> meshes;
  for (std::size_t c = 0; c < chips_.size(); ++c) {
    const ChipFrame& frame = chips_[c];
    if (frame.groups.empty()) continue;
    const std::size_t group = nodes_.begin();
    roots_.push_back(group);
    nodes_.out << "{\"name\":\"debris_" << frame.begin << "\"";
    if (frame.begin > 0) nodes_.out << ",\"scale\":[0,0,0]";
    nodes_.out << ",\"children\":[";
    for (std::size_t g = 0; g < frame.groups.size(); ++g)
      nodes_.out << (g > 0 ? "," : "") << group + 1 + g;
    nodes_.out << "]}";
    animate_visibility(group, frame.begin, c + 1 < chips_.size() ? chips_[c + 1].begin : kUntilEnd);
    for (const ChipGroup& chips : frame.groups) {
      const auto [mesh, is_new] = meshes.try_emplace(chips.material);
      if (is_new) mesh->second = describe_chip_mesh(chips.material);
      nodes_.begin();
      nodes_.out << "{\"mesh\":" << mesh->second << ",\"scale\":["
                 << Vec3f(Vec3f::Constant(kChipNodeScale))
                 << "],\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{"
                 << "\"TRANSLATION\":" << chips.translations << ",\"ROTATION\":" << chips.rotations
                 << ",\"SCALE\":" << chips.scales << "}}}}";
    }
  }
}

/// Returns the number in the document of an element of materials_of_run(), and adds it if it is
/// new.
std::size_t GltfSceneWriter::Scene::used_material(std::size_t index) {
  const auto known = std::ranges::find(used_materials_, index);
  if (known == used_materials_.end()) used_materials_.push_back(index);
  return static_cast<std::size_t>(std::ranges::find(used_materials_, index) -
                                  used_materials_.begin());
}

/// Returns the number of the glTF mesh of an instance, and adds the mesh if it is new.
std::size_t GltfSceneWriter::Scene::mesh_number(const InstanceSpan& span) {
  const std::pair key(span.mesh.value, span.material.value);
  const auto [known, is_new] = mesh_numbers_.try_emplace(key, mesh_list_.size());
  if (!is_new) return known->second;
  const MeshRecord& mesh = meshes_[static_cast<std::size_t>(record_of_mesh_[span.mesh.value])];
  const MaterialIndex material = span.material.none() ? mesh.material : span.material;
  mesh_list_.begin();
  TextWriter& out = mesh_list_.out;
  out << "{\"primitives\":[";
  for (std::size_t part = 0; part < mesh.looks.size(); ++part) {
    out << (part > 0 ? "," : "") << "{\"attributes\":{\"POSITION\":" << mesh.accessors.positions
        << ",\"NORMAL\":" << mesh.accessors.normals;
    const bool has_image = mesh.looks[part] >= Mesh::kFirstAppearance;
    if (has_image && mesh.accessors.uvs) out << ",\"TEXCOORD_0\":" << *mesh.accessors.uvs;
    out << "},\"indices\":" << mesh.accessors.indices[part]
        << ",\"material\":" << used_material(material_of_look(mesh.looks[part], material, *first_))
        << "}";
  }
  out << "]}";
  return known->second;
}

/// Adds the node of a mesh on a body, which holds the scale of its 16-bit coordinates.
std::size_t GltfSceneWriter::Scene::describe_instance(const InstanceSpan& span,
                                                      const BodyRecord& body) {
  const MeshRecord& mesh = meshes_[static_cast<std::size_t>(record_of_mesh_[span.mesh.value])];
  const std::size_t number = mesh_number(span);
  const std::size_t node = nodes_.begin();
  const Vec3f at = (mesh.X_RT * mesh.center_T - body.center_R).cast<float>();
  nodes_.out << "{\"mesh\":" << number << ",\"translation\":[" << at << "]";
  if (mesh.X_RT.rotation.coeffs() != Quat::Identity().coeffs())
    nodes_.out << ",\"rotation\":[" << as_vector(mesh.X_RT.rotation) << "]";
  nodes_.out << ",\"scale\":[" << Vec3f(Vec3f::Constant(static_cast<float>(mesh.half_m))) << "]}";
  return node;
}

/// Adds a node for the meshes that a body has during a part of its life.
std::size_t GltfSceneWriter::Scene::describe_group(std::vector<InstanceSpan>::const_iterator begin,
                                                   std::vector<InstanceSpan>::const_iterator end,
                                                   const BodyRecord& body) {
  std::vector<std::size_t> children;
  for (auto span = begin; span != end; ++span) children.push_back(describe_instance(*span, body));
  const std::size_t node = nodes_.begin();
  nodes_.out << "{";
  if (begin->begin > body.born) nodes_.out << "\"scale\":[0,0,0],";
  nodes_.out << "\"children\":[";
  for (std::size_t c = 0; c < children.size(); ++c) nodes_.out << (c > 0 ? "," : "") << children[c];
  nodes_.out << "]}";
  animate_visibility(node, begin->begin > body.born ? begin->begin : 0,
                     begin->end < body.gone ? begin->end : kUntilEnd);
  return node;
}

/// Returns the name of a body's node: that of the scene, with the key for pieces and copies.
std::string GltfSceneWriter::Scene::name_of_node(const BodyRecord& body) {
  const bool is_named = first_->names && body.name < first_->names->size();
  const std::string root = is_named                 ? (*first_->names)[body.name]
                           : body.key == kGroundKey ? "landscape"
                                                    : "body";
  std::string name = root;
  const bool is_piece = body.parent_key != body.key;
  if (is_piece || names_.contains(name)) name += "_" + std::to_string(body.key);
  while (!names_.insert(name).second) name += "_";
  return name;
}

void GltfSceneWriter::Scene::describe_bodies() {
  std::ranges::sort(bodies_, {}, [](const BodyRecord& b) { return std::pair(b.born, b.key); });
  for (BodyRecord& body : bodies_) {
    describe_body(body, name_of_node(body));
    body.spans = {};
  }
}

void GltfSceneWriter::Scene::describe_body(const BodyRecord& body, const std::string& name) {
  std::vector<InstanceSpan> spans = body.spans;
  const auto life = [](const InstanceSpan& span) { return std::pair(span.begin, span.end); };
  std::ranges::stable_sort(spans, {}, life);
  std::vector<std::size_t> children;
  for (auto span = spans.cbegin(); span != spans.cend();) {
    const auto end = std::find_if(span, spans.cend(),
                                  [&](const InstanceSpan& s) { return life(s) != life(*span); });
    if (span->begin == body.born && span->end == body.gone) {
      for (; span != end; ++span) children.push_back(describe_instance(*span, body));
    } else {
      children.push_back(describe_group(span, end, body));
      span = end;
    }
  }
  const std::size_t node = nodes_.begin();
  roots_.push_back(node);
  TextWriter& out = nodes_.out;
  const double fps = options_.frames_per_s;
  out << "{\"name\":" << json_string(name) << ",\"translation\":[" << body.position
      << "],\"rotation\":[" << Eigen::Vector4f(RotationKeys::read(body.rotation).cast<float>())
      << "]";
  if (body.born > 0) out << ",\"scale\":[0,0,0]";
  for (std::size_t c = 0; c < children.size(); ++c)
    out << (c > 0 ? "," : ",\"children\":[") << children[c];
  if (!children.empty()) out << "]";
  out << ",\"extras\":{\"key\":" << body.key;
  if (body.parent_key != body.key) out << ",\"parent\":" << body.parent_key;
  const bool is_named = first_->names && body.name < first_->names->size();
  out << ",\"root\":" << (is_named ? json_string((*first_->names)[body.name]) : "null")
      << ",\"name\":" << json_string(name);
  if (body.mass_kg > 0) out << ",\"mass_kg\":" << body.mass_kg;
  out << ",\"born_s\":" << body.born / fps << ",\"gone_s\":";
  if (body.gone == kUntilEnd) {
    out << "null}}";
  } else {
    out << body.gone / fps << "}}";
  }
  if (body.positions) animate(node, "translation", *body.positions, false);
  if (body.rotations) animate(node, "rotation", *body.rotations, false);
  animate_visibility(node, body.born, body.gone);
}

/// Describes the materials that the document uses.
json GltfSceneWriter::Scene::describe_materials() {
  constexpr double kGlassOpacity = 0.35;
  json described = json::array();
  for (const std::size_t index : used_materials_) {
    json& material = described.emplace_back(material_writer_.describe(materials_[index]));
    const std::size_t of_scene = index / 2;
    if (of_scene < first_->materials->size() &&
        (*first_->materials)[of_scene].surface.texture == Texture::kGlass) {
      material["alphaMode"] = "BLEND";
      material["pbrMetallicRoughness"]["baseColorFactor"][3] = kGlassOpacity;
    }
  }
  return described;
}

/// Returns the side data of the run as JSON.
std::string GltfSceneWriter::Scene::extras() const {
  TextWriter out(",");
  const double fps = options_.frames_per_s;
  out << "{\"sunder\":{\"scene\":" << json_string(options_.scene) << ",\"fps\":" << fps
      << ",\"frames\":" << next_ << ",\"duration_s\":" << (next_ - 1) / fps
      << ",\"tolerance_m\":" << options_.tolerance_m
      << ",\"tolerance_deg\":" << options_.tolerance_deg
      << ",\"ground_m\":" << first_->view.ground_m << ",\n";
  side_data_.describe(out);
  out << "}}";
  return out.text;
}

/// Returns the JSON of the document; completes the buffers.
std::string GltfSceneWriter::Scene::document() {
  describe_camera_and_sun();
  describe_ground();
  describe_bodies();
  describe_chips();
  const json materials = describe_materials();
  buffers_.finish(next_);
  figures.frames = next_;
  figures.bodies = bodies_.size();
  figures.meshes = meshes_.size();
  figures.breaks = side_data_.breaks();
  const View& view = first_->view;
  const Vec3f sun = view.sun_color * static_cast<float>(view.sun_strength);
  const float intensity = std::max(sun.maxCoeff(), 1e-6f);
  TextWriter out(",");
  out << "{\"asset\":{\"version\":\"2.0\",\"generator\":\"sunder\",\"extras\":" << extras()
      << "},\n\"extensionsUsed\":[" << (chip_ ? "\"EXT_mesh_gpu_instancing\"," : "")
      << "\"KHR_lights_punctual\",\"KHR_mesh_quantization\"],"
      << "\"extensionsRequired\":[\"KHR_mesh_quantization\"],\n"
      << "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"directional\","
      << "\"name\":\"sun\",\"color\":[" << Vec3f((sun / intensity).cwiseMin(1.f))
      << "],\"intensity\":" << intensity << "}]}},\n"
      << "\"cameras\":[{\"name\":\"camera\",\"type\":\"perspective\",\"perspective\":{\"yfov\":"
      << view.fov_rad << ",\"znear\":0.05}}],\n\"scene\":0,\"scenes\":[{\"nodes\":[";
  for (std::size_t r = 0; r < roots_.size(); ++r) out << (r > 0 ? "," : "") << roots_[r];
  out << "]}],\n\"materials\":" << materials.dump() << ",\n";
  json images = json::object();
  material_writer_.add_images(images, buffers_.views());
  if (!images.empty()) {
    out << "\"textures\":" << images["textures"].dump()
        << ",\n\"images\":" << images["images"].dump() << ",\n";
  }
  out << "\"nodes\":[" << nodes_.out.text << "],\n\"meshes\":[" << mesh_list_.out.text << "],\n";
  if (channels_.size() > 0) {
    out << "\"animations\":[{\"name\":\"run\",\"channels\":[" << channels_.out.text
        << "],\n\"samplers\":[" << samplers_.out.text << "]}],\n";
  }
  out << "\"accessors\":[";
  buffers_.describe_accessors(out);
  out << "],\n\"bufferViews\":[";
  std::vector<std::size_t> picture_sizes;
  for (const EncodedImage& picture : material_writer_.pictures())
    picture_sizes.push_back(picture->size());
  const std::uint64_t length = buffers_.describe_views(out, picture_sizes);
  out << "],\n\"buffers\":[{\"byteLength\":" << length << "}]}";
  figures.bytes = length;
  out.text.append((4 - out.text.size() % 4) % 4, ' ');
  return std::move(out.text);
}

/// Writes the file. `text`: the JSON of the document.
void GltfSceneWriter::Scene::write(const std::string& text) {
  const std::uint64_t binary = figures.bytes;
  figures.bytes = 28 + text.size() + binary;
  if (figures.bytes > kMaxBytes) {
    throw FileError(path_.string() +
                    ": the run needs more than the 4 GB of a GLB file; export fewer frames, or "
                    "with a larger --tolerance");
  }
  if (is_device(path_)) return write_parts(path_, text, binary);
  UnfinishedFile file(path_);
  write_parts(file.path(), text, binary);
  file.publish();
}

/// Writes header, JSON and data of the file to `place`.
void GltfSceneWriter::Scene::write_parts(const std::filesystem::path& place,
                                         const std::string& text, std::uint64_t binary) {
  std::ofstream out = create_file(place);
  const auto put = [&](std::span<const std::byte> bytes) {
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
  };
  const auto put_numbers = [&](std::initializer_list<std::uint64_t> numbers) {
    ByteWriter header;
    for (const std::uint64_t number : numbers) header.put(static_cast<std::uint32_t>(number));
    put(header.bytes);
  };
  put_numbers({kMagic, 2, figures.bytes, text.size(), kJson});
  put(std::as_bytes(std::span(text)));
  put_numbers({binary, kBinary});
  buffers_.read(put);
  for (const EncodedImage& picture : material_writer_.pictures()) {
    put(*picture);
    constexpr std::byte kZeros[4] = {};
    put(std::span(kZeros, (4 - picture->size() % 4) % 4));
  }
  out.close();
  if (!out) throw FileError(path_.string() + ": cannot be written; is the disk full?");
}

GltfSceneWriter::GltfSceneWriter(const std::filesystem::path& path, const GltfSceneOptions& options)
    : scene_(std::make_unique<Scene>(path, options)) {}
GltfSceneWriter::~GltfSceneWriter() = default;
void GltfSceneWriter::take(const FramePtr& frame) { scene_->take(frame); }
void GltfSceneWriter::finish() { scene_->finish(); }
const GltfSceneFigures& GltfSceneWriter::figures() const { return scene_->figures; }

}  // namespace sunder
