#include "engine/io/frame_parts.h"

namespace sunder {
namespace {

void put(ByteWriter& out, const Vec3f& v) {
  for (int i = 0; i < 3; ++i) out.put(v[i]);
}
void put(ByteWriter& out, const Look& look) {
  out.put(look.texture);
  put(out, look.color);
}
Vec3f take_vec3f(ByteReader& in) {
  Vec3f v;
  for (int i = 0; i < 3; ++i) v[i] = in.take<float>();
  return v;
}
Look take_look(ByteReader& in) {
  Look look;
  look.texture = in.take<Texture>();
  look.color = take_vec3f(in);
  return look;
}

}  // namespace

void put(ByteWriter& out, const Vec3& v) {
  for (int i = 0; i < 3; ++i) out.put(v[i]);
}
Vec3 take_vec3(ByteReader& in) {
  Vec3 v;
  for (int i = 0; i < 3; ++i) v[i] = in.take<double>();
  return v;
}
void put(ByteWriter& out, const View& view) {
  put(out, view.eye_W);
  put(out, view.target_W);
  put(out, view.to_sun_W);
  put(out, view.ground_color);
  out.put(view.fov_rad);
  out.put(view.ground_m);
}
View take_view(ByteReader& in) {
  View view;
  view.eye_W = take_vec3(in);
  view.target_W = take_vec3(in);
  view.to_sun_W = take_vec3(in);
  view.ground_color = take_vec3f(in);
  view.fov_rad = in.take<double>();
  view.ground_m = in.take<double>();
  return view;
}

void put(ByteWriter& out, const Mesh& mesh) {
  put(out, mesh.origin_R);
  out.put(mesh.material.value);
  out.put(static_cast<std::uint32_t>(mesh.vertices.size()));
  for (const Mesh::Vertex& vertex : mesh.vertices) {
    put(out, vertex.position);
    put(out, vertex.normal);
    out.put(vertex.interior);
  }
  out.put(static_cast<std::uint32_t>(mesh.indices.size()));
  for (const std::uint32_t index : mesh.indices) out.put(index);
}
Mesh take_mesh(ByteReader& in, const std::string& file, std::size_t materials) {
  Mesh mesh;
  mesh.origin_R = take_vec3(in);
  mesh.material = MaterialIndex(in.take<std::uint32_t>());
  mesh.vertices.resize(in.take_count(28));
  for (Mesh::Vertex& vertex : mesh.vertices) {
    vertex.position = take_vec3f(in);
    vertex.normal = take_vec3f(in);
    vertex.interior = in.take<std::uint32_t>();
  }
  mesh.indices.resize(in.take_count(4));
  for (std::uint32_t& index : mesh.indices) {
    index = in.take<std::uint32_t>();
    if (index >= mesh.vertices.size())
      throw InputError(file + ": corrupt: a triangle has no corner");
  }
  if (mesh.material.value >= materials)
    throw InputError(file + ": corrupt: a mesh has no material");
  return mesh;
}

void put(ByteWriter& out, const std::vector<Material>& materials) {
  out.put(static_cast<std::uint32_t>(materials.size()));
  for (const Material& material : materials) {
    out.put(material.name);
    put(out, material.surface);
    put(out, material.interior);
  }
}

std::vector<Material> take_materials(ByteReader& in) {
  std::vector<Material> materials(in.take_count(30));
  for (Material& material : materials) {
    material.name = in.take_text();
    material.surface = take_look(in);
    material.interior = take_look(in);
  }
  return materials;
}

}  // namespace sunder
