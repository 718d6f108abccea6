#include "engine/io/scene_export/chip_nodes.h"

#include <array>
#include <map>

namespace sunder {

Mesh make_chip() {
  // Two corners on each axis, of which no two are opposite.
  const std::array<Vec3f, 6> corners = {Vec3f(0.95f, 0.2f, 0.1f), Vec3f(-0.8f, 0.1f, -0.3f),
                                        Vec3f(0.1f, 0.6f, 0.2f),  Vec3f(-0.1f, -0.7f, 0.1f),
                                        Vec3f(0.2f, -0.1f, 0.9f), Vec3f(-0.2f, 0.1f, -0.85f)};
  constexpr std::array<std::array<std::size_t, 3>, 8> kFaces = {
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  Mesh chip;
  for (const auto& [a, b, c] : kFaces) {
    const Vec3f normal = (corners[b] - corners[a]).cross(corners[c] - corners[a]).normalized();
    for (const std::size_t corner : {a, b, c}) {
      chip.indices.push_back(static_cast<std::uint32_t>(chip.vertices.size()));
      chip.vertices.push_back({corners[corner], normal, Mesh::kInterior});
    }
  }
  return chip;
}

ChipFrame add_chips(std::uint32_t number, const std::vector<FrameDebris>& debris,
                    GltfBuffers& buffers) {
  struct Attributes {
    std::vector<Vec3f> translations, scales;
    std::vector<RotationKeys::Key> rotations;
  };
  std::map<MaterialIndex, Attributes> by_material;
  for (const FrameDebris& chip : debris) {
    Attributes& all = by_material[chip.material];
    all.translations.push_back(chip.position_W / kChipNodeScale);
    all.rotations.push_back(RotationKeys::store(chip.rotation_WD.cast<double>(), nullptr));
    all.scales.push_back(Vec3f::Constant(chip.radius_m / kChipNodeScale));
  }
  ChipFrame frame{number, {}};
  for (const auto& [material, all] : by_material) {
    frame.groups.push_back({material, buffers.add_vectors(all.translations),
                            buffers.add_rotations(all.rotations), buffers.add_vectors(all.scales)});
  }
  return frame;
}

}  // namespace sunder
