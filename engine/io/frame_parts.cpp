#include "engine/io/frame_parts.h"

#include <algorithm>

namespace sunder {
namespace {

constexpr std::uint32_t kNoPicture = ~std::uint32_t{0};

// Flags of the optional members that follow.
constexpr unsigned kVFromBottom = 1, kRelief = 2, kGloss = 4;

}  // namespace

void put(ByteWriter& out, const View& view) {
  out.put(view.eye_W, view.target_W, view.to_sun_W, view.ground_color, view.fov_rad, view.ground_m);
  out.put(view.exposure, view.shutter, view.sun_color, view.sky_color, view.sun_strength,
          view.sky_strength);
}

View take_view(ByteReader& in) {
  View view;
  in.take_to(view.eye_W, view.target_W, view.to_sun_W, view.ground_color, view.fov_rad,
             view.ground_m);
  in.take_to(view.exposure, view.shutter, view.sun_color, view.sky_color, view.sun_strength,
             view.sky_strength);
  return view;
}

void put(ByteWriter& out, const Mesh& mesh) {
  out.put(mesh.X_RT.position, mesh.X_RT.rotation.coeffs(), mesh.origin_T, mesh.material);
  out.put(static_cast<std::uint32_t>(mesh.vertices.size()));
  for (const Mesh::Vertex& vertex : mesh.vertices) {
    out.put(vertex.position, vertex.normal, vertex.look);
  }
  out.put_list(mesh.indices);
}

Mesh take_mesh(ByteReader& in, const std::string& file, std::size_t materials) {
  Mesh mesh;
  in.take_to(mesh.X_RT.position, mesh.X_RT.rotation.coeffs(), mesh.origin_T, mesh.material);
  mesh.vertices.resize(in.take_count(28));
  for (Mesh::Vertex& vertex : mesh.vertices) {
    in.take_to(vertex.position, vertex.normal, vertex.look);
  }
  mesh.indices = in.take_list<std::uint32_t>();
  for (const std::uint32_t index : mesh.indices) {
    if (index >= mesh.vertices.size())
      throw InputError(file + ": corrupt: a triangle has an invalid vertex");
  }
  if (mesh.material.value >= materials)
    throw InputError(file + ": corrupt: a mesh has an invalid material");
  return mesh;
}

void put_uvs(ByteWriter& out, std::span<const std::shared_ptr<const Mesh>> meshes) {
  for (std::uint32_t m = 0; m < meshes.size(); ++m) {
    if (meshes[m]->uvs.empty()) continue;
    out.put(m);
    out.put_list(meshes[m]->uvs);
  }
  out.put(~std::uint32_t{0});
}

void take_uvs(ByteReader& in, const std::string& file, std::span<Mesh> meshes) {
  for (std::uint32_t m; (m = in.take<std::uint32_t>()) != ~std::uint32_t{0};) {
    if (m >= meshes.size())
      throw InputError(file + ": corrupt: texture coordinates have an invalid mesh");
    meshes[m].uvs = in.take_list<Eigen::Vector2f>();
    if (meshes[m].uvs.size() != meshes[m].vertices.size())
      throw InputError(file + ": corrupt: a vertex has no texture coordinates");
  }
}

void check_appearances(const Mesh& mesh, const std::string& file, std::size_t appearances) {
  for (const Mesh::Vertex& vertex : mesh.vertices) {
    if (vertex.look >= Mesh::kFirstAppearance + appearances)
      throw InputError(file + ": corrupt: a mesh has an invalid appearance");
  }
}

void put(ByteWriter& out, const std::vector<Appearance>& appearances) {
  std::vector<const std::vector<std::byte>*> pictures;  // each once
  const auto put_picture = [&](const EncodedImage& picture) {
    const auto known = std::find(pictures.begin(), pictures.end(), picture.get());
    out.put(picture ? static_cast<std::uint32_t>(known - pictures.begin()) : kNoPicture);
    if (!picture || known != pictures.end()) return;
    pictures.push_back(picture.get());
    out.put_list(*picture);
  };
  out.put(static_cast<std::uint32_t>(appearances.size()));
  for (const Appearance& appearance : appearances) {
    out.put(appearance.color,
            static_cast<std::uint8_t>((appearance.v_from_bottom ? kVFromBottom : 0) |
                                      (appearance.relief ? kRelief : 0) |
                                      (appearance.gloss ? kGloss : 0)));
    put_picture(appearance.picture);
    if (appearance.relief) {
      put_picture(appearance.relief);
      out.put(appearance.normal_scale);
    }
    if (appearance.gloss) {
      out.put(appearance.gloss->roughness, appearance.gloss->metallic);
      put_picture(appearance.gloss->picture);
    }
  }
}

std::vector<Appearance> take_appearances(ByteReader& in, const std::string& file) {
  std::vector<EncodedImage> pictures;
  const auto take_picture = [&]() -> EncodedImage {
    const auto number = in.take<std::uint32_t>();
    if (number == kNoPicture) return nullptr;
    if (number > pictures.size())
      throw InputError(file + ": corrupt: an appearance has an invalid texture");
    if (number == pictures.size()) {
      pictures.push_back(std::make_shared<const std::vector<std::byte>>(in.take_list<std::byte>()));
    }
    return pictures[number];
  };
  std::vector<Appearance> appearances(in.take_count(17));
  for (Appearance& appearance : appearances) {
    in.take_to(appearance.color);
    const auto flags = in.take<std::uint8_t>();
    appearance.v_from_bottom = (flags & kVFromBottom) != 0;
    appearance.picture = take_picture();
    if ((flags & kRelief) != 0) {
      appearance.relief = take_picture();
      in.take_to(appearance.normal_scale);
    }
    if ((flags & kGloss) != 0) {
      appearance.gloss.emplace();
      in.take_to(appearance.gloss->roughness, appearance.gloss->metallic);
      appearance.gloss->picture = take_picture();
    }
  }
  return appearances;
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
