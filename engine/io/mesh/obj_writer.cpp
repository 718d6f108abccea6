#include "engine/io/mesh/obj_writer.h"

#include <string>

#include "engine/geometry/triangulate_face.h"
#include "engine/io/bytes.h"
#include "engine/io/mesh/export_folder.h"
#include "engine/io/text_writer.h"

namespace sunder {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMaterials = "materials.mtl";

/// Returns a material name without blanks, which OBJ and MTL do not allow.
std::string as_word(std::string name) {
  for (char& c : name) {
    if (c == ' ' || c == '\t') c = '_';
  }
  return name;
}

void write_materials(const fs::path& file, const Model& model) {
  TextWriter out;
  for (const Model::Material& material : model.materials) {
    out << "newmtl " << as_word(material.name) << "\nKd " << material.look.color << "\n";
  }
  write_file(file, out.text);
}

void write_triangles(TextWriter& out, const std::string& material,
                     const std::vector<std::uint32_t>& indices, const ShellTriangles& triangles,
                     std::size_t first_point, std::size_t first_vertex) {
  out << "usemtl " << as_word(material) << "\n";
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const std::size_t point = first_point + triangles.vertices[indices[i]].point;
    const std::size_t vertex = first_vertex + indices[i];
    out << (i % 3 == 0 ? "f " : " ") << point << "/" << vertex << "/" << vertex;
    if (i % 3 == 2) out << "\n";
  }
}

void write_points(TextWriter& out, const Model::Part& part, const Model::Shell& shell) {
  for (const Vec3& vertex : shell.mesh->vertices) {
    out << "v " << Vec3(vertex + part.offset) << "\n";
  }
}

void write_part(const fs::path& file, const Model::Part& part, const Model& model) {
  TextWriter out;
  out << "mtllib " << kMaterials << "\no " << part.name << "\n";
  std::size_t first_point = 1, first_vertex = 1;
  for (const Model::Shell& shell : part.shells) {
    const ShellTriangles triangles = triangles_of(shell);
    write_points(out, part, shell);
    for (const ShellTriangles::Vertex& vertex : triangles.vertices) {
      out << "vt " << vertex.uv << "\nvn " << vertex.normal << "\n";
    }
    for (const auto& [material, indices] : triangles.faces) {
      write_triangles(out, model.materials[material].name, indices, triangles, first_point,
                      first_vertex);
    }
    first_point += shell.mesh->vertices.size();
    first_vertex += triangles.vertices.size();
  }
  write_file(file, out.text);
}

bool is_own(const std::string& name) {
  return name == kMaterials || (name.starts_with("piece_") && name.ends_with(".obj"));
}

}  // namespace

void write_obj(const fs::path& file, const Model& model) {
  TextWriter out;
  std::size_t first = 1;
  for (const Model::Part& part : model.parts) {
    out << "o " << as_word(part.name) << "\n";
    for (const Model::Shell& shell : part.shells) {
      const PolygonMesh& mesh = *shell.mesh;
      write_points(out, part, shell);
      for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        for (const Triangle& corners : triangulate(mesh, f)) {
          out << "f";
          for (const std::uint32_t corner : corners) out << " " << first + mesh.corners[corner];
          out << "\n";
        }
      }
      first += mesh.vertices.size();
    }
  }
  write_file(file, out.text);
}

void write_obj_folder(const fs::path& place, const Model& model) {
  ExportFolder folder(place, is_own);
  write_materials(folder.path() / kMaterials, model);
  for (const Model::Part& part : model.parts) {
    write_part(folder.path() / (part.name + ".obj"), part, model);
  }
  folder.publish();
}

}  // namespace sunder
