// The parts of a frame that files store as they are: views, materials' looks, meshes.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/io/bytes.h"
#include "engine/model/frame.h"

namespace sunder {

void put(ByteWriter& out, const View& view);
/// `lit`: with its exposure, shutter and lights, as put() has it; older files have none.
View take_view(ByteReader& in, bool lit = true);

/// Names and looks: what pictures need of them.
void put(ByteWriter& out, const std::vector<Material>& materials);
std::vector<Material> take_materials(ByteReader& in);

/// Frame::names.
void put_names(ByteWriter& out, const std::vector<std::string>& names);
std::vector<std::string> take_names(ByteReader& in);

void put(ByteWriter& out, const Mesh& mesh);
/// Throws InputError, naming `file`, if the mesh does not fit together or its material is none of
/// `materials`.
/// `posed`: with Mesh::X_RT, as put() has it; older files have none.
Mesh take_mesh(ByteReader& in, const std::string& file, std::size_t materials, bool posed = true);
/// Texture coordinates of those meshes that have any; what older files and runs do without.
void put_uvs(ByteWriter& out, std::span<const std::shared_ptr<const Mesh>> meshes);
void take_uvs(ByteReader& in, const std::string& file, std::span<Mesh> meshes);
/// Throws InputError unless the mesh does with so many paints.
void check_looks(const Mesh& mesh, const std::string& file, std::size_t paints);

/// Each picture once.
void put(ByteWriter& out, const std::vector<Paint>& paints);
std::vector<Paint> take_paints(ByteReader& in, const std::string& file);

/// The least bytes that a mesh takes.
inline constexpr std::size_t kLeastMeshBytes = 36;

}  // namespace sunder
