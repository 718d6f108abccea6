// Storage of parts of a frame that files have in common: views, appearance of materials, meshes.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/io/bytes.h"
#include "engine/model/frame.h"

namespace sunder {

/// Appends a view to `out`.
void put(ByteWriter& out, const View& view);
View take_view(ByteReader& in);

/// Appends the names and appearance of materials; other properties are not stored.
void put(ByteWriter& out, const std::vector<Material>& materials);
std::vector<Material> take_materials(ByteReader& in);

/// Appends Frame::names.
void put_names(ByteWriter& out, const std::vector<std::string>& names);
std::vector<std::string> take_names(ByteReader& in);

/// Appends a mesh without its texture coordinates.
void put(ByteWriter& out, const Mesh& mesh);
/// Reads a mesh. Throws InputError, naming `file`, if its indices are invalid or its material is
/// not below `materials`.
Mesh take_mesh(ByteReader& in, const std::string& file, std::size_t materials);
/// Appends the texture coordinates of those meshes that have them.
void put_uvs(ByteWriter& out, std::span<const std::shared_ptr<const Mesh>> meshes);
void take_uvs(ByteReader& in, const std::string& file, std::span<Mesh> meshes);
/// Throws InputError if the mesh uses an appearance beyond `appearances`.
void check_appearances(const Mesh& mesh, const std::string& file, std::size_t appearances);

/// Appends the appearance of mesh files' faces; each image is stored once.
void put(ByteWriter& out, const std::vector<Appearance>& appearances);
std::vector<Appearance> take_appearances(ByteReader& in, const std::string& file);

/// Least number of bytes that a stored mesh takes.
inline constexpr std::size_t kMinMeshBytes = 36;

}  // namespace sunder
