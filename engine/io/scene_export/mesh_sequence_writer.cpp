// Begin with take(). Instances are written in chunks, which are joined in order.
#include "engine/io/scene_export/mesh_sequence_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/io/bytes.h"
#include "engine/io/scene_export/run_materials.h"
#include "engine/io/text_writer.h"

namespace sunder {
namespace {

constexpr std::size_t kInstancesAChunk = 32;
constexpr const char* kMaterialFile = "materials.mtl";

bool is_sequence_file(const std::string& name) {
  return name == kMaterialFile || name.starts_with("image_") ||
         (name.starts_with("frame_") && (name.ends_with(".obj") || name.ends_with(".ply")));
}

/// Returns a name without blanks, which OBJ and MTL do not allow.
std::string as_one_word(std::string name) {
  std::ranges::replace_if(
      name, [](char c) { return c == ' ' || c == '\t'; }, '_');
  return name;
}

/// An instance with its place in the file.
struct Placed {
  const FrameBody* body = nullptr;
  const Mesh* mesh = nullptr;
  MaterialIndex material;
  bool is_first = false;           ///< True for the first instance of its body.
  std::uint64_t first_vertex = 0;  ///< Number of vertices before.
  std::uint64_t first_uv = 0;      ///< Number of texture coordinates before.

  Vec3f point(const Mesh::Vertex& vertex) const {
    const Vec3 point_T = mesh->origin_T + vertex.position.cast<double>();
    return (body->X_WB * (mesh->X_RT * point_T - body->com_R)).cast<float>();
  }
  Mat3f rotation() const {
    return (body->X_WB.rotation * mesh->X_RT.rotation).toRotationMatrix().cast<float>();
  }
};

/// Returns what the frame draws, by body.
std::vector<Placed> place_instances(const Frame& frame) {
  std::vector<Instance> sorted = frame.instances;
  std::ranges::stable_sort(sorted, {}, &Instance::body);
  std::vector<Placed> placed;
  std::uint64_t vertices = 0, uvs = 0;
  for (const Instance& instance : sorted) {
    const Mesh& mesh = *(*frame.meshes)[instance.mesh.value];
    if (mesh.indices.empty()) continue;
    const FrameBody& body = frame.bodies[instance.body];
    placed.push_back({&body, &mesh, instance.material.none() ? mesh.material : instance.material,
                      placed.empty() || placed.back().body != &body, vertices, uvs});
    vertices += mesh.vertices.size();
    uvs += mesh.uvs.size();
  }
  return placed;
}

std::string name_of(const FrameBody& body, const Frame& frame) {
  const bool is_named = frame.names && body.name < frame.names->size();
  return as_one_word(is_named ? (*frame.names)[body.name] : "body") + "_" +
         std::to_string(body.key);
}

void put_obj(TextWriter& out, const Placed& at, const Frame& frame,
             const std::vector<Model::Material>& materials) {
  if (at.is_first) out << "o " << name_of(*at.body, frame) << "\n";
  const Mat3f rotation = at.rotation();
  for (const Mesh::Vertex& vertex : at.mesh->vertices) {
    out << "v " << at.point(vertex) << "\nvn " << Vec3f(rotation * vertex.normal) << "\n";
  }
  for (std::size_t v = 0; v < at.mesh->uvs.size(); ++v) {
    const std::uint32_t look = at.mesh->vertices[v].look;
    Eigen::Vector2f uv = at.mesh->uvs[v];
    const bool is_from_top = look >= Mesh::kFirstAppearance &&
                             !(*frame.appearances)[look - Mesh::kFirstAppearance].v_from_bottom;
    if (is_from_top) uv.y() = 1 - uv.y();
    out << "vt " << uv << "\n";
  }
  std::uint32_t look = ~std::uint32_t{0};
  const std::vector<std::uint32_t>& indices = at.mesh->indices;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    if (const std::uint32_t now = at.mesh->vertices[indices[i]].look; now != look) {
      look = now;
      const std::string& name = materials[material_of_look(look, at.material, frame)].name;
      out << "usemtl " << as_one_word(name) << "\n";
    }
    out << "f";
    for (std::size_t corner = i; corner < i + 3; ++corner) {
      const std::uint64_t number = at.first_vertex + indices[corner] + 1;
      out << " " << number << "/";
      if (!at.mesh->uvs.empty()) out << at.first_uv + indices[corner] + 1;
      out << "/" << number;
    }
    out << "\n";
  }
}

/// Returns a linear colour in the 8 bits of sRGB.
std::array<std::uint8_t, 3> srgb(const Vec3f& color) {
  std::array<std::uint8_t, 3> bytes = {};
  for (std::size_t i = 0; i < 3; ++i) {
    const double x = std::clamp(static_cast<double>(color[static_cast<Eigen::Index>(i)]), 0., 1.);
    const double coded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    bytes[i] = static_cast<std::uint8_t>(std::lround(255 * coded));
  }
  return bytes;
}

void put_ply(ByteWriter& vertices, ByteWriter& faces, const Placed& at, const Frame& frame,
             const std::vector<Model::Material>& materials) {
  const Mat3f rotation = at.rotation();
  for (const Mesh::Vertex& vertex : at.mesh->vertices) {
    vertices.put(at.point(vertex));
    vertices.put(Vec3f(rotation * vertex.normal));
    vertices.put(srgb(materials[material_of_look(vertex.look, at.material, frame)].look.color));
    vertices.put(static_cast<std::uint32_t>(at.body->key));
  }
  const std::vector<std::uint32_t>& indices = at.mesh->indices;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    faces.put(std::uint8_t{3});
    for (std::size_t corner = i; corner < i + 3; ++corner)
      faces.put(static_cast<std::uint32_t>(at.first_vertex + indices[corner]));
  }
}

std::string_view text_of(const ByteWriter& writer) {
  return {reinterpret_cast<const char*>(writer.bytes.data()), writer.bytes.size()};
}

std::string obj_of(const Frame& frame, const std::vector<Model::Material>& materials) {
  const std::vector<Placed> placed = place_instances(frame);
  std::vector<TextWriter> parts((placed.size() + kInstancesAChunk - 1) / kInstancesAChunk);
  for_chunks(placed.size(), kInstancesAChunk, [&](std::size_t i, std::size_t end, std::size_t c) {
    for (; i < end; ++i) put_obj(parts[c], placed[i], frame, materials);
  });
  std::string text = std::string("mtllib ") + kMaterialFile + "\n";
  for (const TextWriter& part : parts) text += part.text;
  return text;
}

std::string ply_of(const Frame& frame, const std::vector<Model::Material>& materials) {
  const std::vector<Placed> placed = place_instances(frame);
  struct Part {
    ByteWriter vertices, faces;
  };
  std::vector<Part> parts((placed.size() + kInstancesAChunk - 1) / kInstancesAChunk);
  for_chunks(placed.size(), kInstancesAChunk, [&](std::size_t i, std::size_t end, std::size_t c) {
    for (; i < end; ++i) put_ply(parts[c].vertices, parts[c].faces, placed[i], frame, materials);
  });
  std::uint64_t vertices = 0, faces = 0;
  for (const Placed& at : placed) {
    vertices += at.mesh->vertices.size();
    faces += at.mesh->indices.size() / 3;
  }
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) +
      "\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "property uint key\nelement face " +
      std::to_string(faces) + "\nproperty list uchar uint vertex_indices\nend_header\n";
  for (const Part& part : parts) text += text_of(part.vertices);
  for (const Part& part : parts) text += text_of(part.faces);
  return text;
}

}  // namespace

SequenceFormat sequence_format(const std::string& name) {
  if (name == "obj") return SequenceFormat::kObj;
  if (name == "ply") return SequenceFormat::kPly;
  throw InputError("--format " + name + ": expected obj or ply");
}

MeshSequenceWriter::MeshSequenceWriter(const std::filesystem::path& folder, SequenceFormat format,
                                       int frames_per_s)
    : folder_(folder, is_sequence_file),
      format_(format),
      step_(static_cast<std::uint64_t>(60 / frames_per_s)) {
  SUNDER_CHECK(frames_per_s > 0 && 60 % frames_per_s == 0);
}

void MeshSequenceWriter::write(const std::string& name, std::string_view content) {
  write_file(folder_.path() / name, content);
  bytes_ += content.size();
}

/// Writes materials.mtl and the images of mesh files.
void MeshSequenceWriter::write_materials(const Frame& frame) {
  materials_ = materials_of_run(frame);
  if (format_ != SequenceFormat::kObj) return;
  TextWriter out;
  std::vector<EncodedImage> images;
  const auto name_of_image = [&](const EncodedImage& image) {
    const auto known = std::ranges::find(images, image);
    const auto number = static_cast<std::size_t>(known - images.begin());
    const bool is_png = !image->empty() && image->front() == std::byte{0x89};
    const std::string name = "image_" + std::to_string(number) + (is_png ? ".png" : ".jpg");
    if (known == images.end()) {
      images.push_back(image);
      write(name, {reinterpret_cast<const char*>(image->data()), image->size()});
    }
    return name;
  };
  for (const Model::Material& material : materials_) {
    out << "newmtl " << as_one_word(material.name) << "\nKd " << material.look.color << "\n";
    if (material.look.picture) out << "map_Kd " << name_of_image(material.look.picture) << "\n";
  }
  write(kMaterialFile, out.text);
}

void MeshSequenceWriter::take(const FramePtr& frame) {
  if (taken_++ % step_ != 0) return;
  if (frames_ == 0) write_materials(*frame);
  const bool is_obj = format_ == SequenceFormat::kObj;
  char name[40];
  std::snprintf(name, sizeof name, "frame_%05llu.%s", static_cast<unsigned long long>(frames_),
                is_obj ? "obj" : "ply");
  write(name, is_obj ? obj_of(*frame, materials_) : ply_of(*frame, materials_));
  ++frames_;
}

void MeshSequenceWriter::finish() {
  if (frames_ > 0) folder_.publish();
}

}  // namespace sunder
