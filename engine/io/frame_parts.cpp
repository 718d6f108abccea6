#include "engine/io/frame_parts.h"

namespace sunder {
void put(ByteWriter& out, const View& view) {
  out.put(view.eye_W, view.target_W, view.to_sun_W, view.ground_color, view.fov_rad, view.ground_m);
}

View take_view(ByteReader& in) {
  View view;
  in.take_to(view.eye_W, view.target_W, view.to_sun_W, view.ground_color, view.fov_rad,
             view.ground_m);
  return view;
}

void put(ByteWriter& out, const Mesh& mesh) {
  out.put(mesh.X_RT.position, mesh.X_RT.rotation.coeffs(), mesh.origin_T, mesh.material);
  out.put(static_cast<std::uint32_t>(mesh.vertices.size()));
  for (const Mesh::Vertex& vertex : mesh.vertices) {
    out.put(vertex.position, vertex.normal, vertex.interior);
  }
  out.put_list(mesh.indices);
}

Mesh take_mesh(ByteReader& in, const std::string& file, std::size_t materials, bool posed) {
  Mesh mesh;
  if (posed) in.take_to(mesh.X_RT.position, mesh.X_RT.rotation.coeffs());
  in.take_to(mesh.origin_T, mesh.material);
  mesh.vertices.resize(in.take_count(28));
  for (Mesh::Vertex& vertex : mesh.vertices) {
    in.take_to(vertex.position, vertex.normal, vertex.interior);
  }
  mesh.indices = in.take_list<std::uint32_t>();
  for (const std::uint32_t index : mesh.indices) {
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
    out.put(material.name, material.surface.texture, material.surface.color);
    out.put(material.interior.texture, material.interior.color);
  }
}

std::vector<Material> take_materials(ByteReader& in) {
  std::vector<Material> materials(in.take_count(30));
  for (Material& material : materials) {
    in.take_to(material.name, material.surface.texture, material.surface.color);
    in.take_to(material.interior.texture, material.interior.color);
  }
  return materials;
}

void put_names(ByteWriter& out, const std::vector<std::string>& names) {
  out.put(static_cast<std::uint32_t>(names.size()));
  for (const std::string& name : names) out.put(name);
}

std::vector<std::string> take_names(ByteReader& in) {
  std::vector<std::string> names(in.take_count(4));
  for (std::string& name : names) in.take_to(name);
  return names;
}

}  // namespace sunder
