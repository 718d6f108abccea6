#include "fracture/rejoin.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "engine/base/hash.h"
#include "engine/geometry/polygon_mesh.h"
#include "engine/model/bent_section.h"
#include "fracture/adjacency/adjacency.h"

namespace sunder::fracture {
namespace {

class Rejoining {
 public:
  explicit Rejoining(const BentPair& bent) : bent_(bent) {}

  Rejoined run() {
    if (!end_sections() || wall_ends() || !lets_end(bent_.a, 0) || !lets_end(bent_.b, 1) ||
        !weigh_ends())
      return {};
    take_in();
    return std::move(result_);
  }

 private:
  using Endings = std::map<ConvexSlot, ConvexPtr>;

  /// A name for all time that nothing else has, of a plane that had that name in b.
  PlaneId fresh(PlaneId old) const {
    return {combine(bent_.event, old.value >> 1) << 1 | (old.value & 1)};
  }
  /// What a plane in which a section ends is called in b until that is moved: names of planes are
  /// small numbers, or random.
  static PlaneId name_in_b(std::size_t section) { return {~std::uint64_t{2 * section}}; }

  /// What ends in other planes, on both sides; false if they are bent too far.
  bool end_sections() {
    for (std::size_t i = 0; i < bent_.sections.size(); ++i) {
      const BentSection& s = bent_.sections[i];
      const BentSide a{bent_.a,  s.slots_a, s.faces_a, s.areas_m2, {s.centroid_A, s.normal_A},
                       s.reach_m};
      const BentSide b{bent_.b,  s.slots_b, s.faces_b, s.areas_m2, {s.centroid_B, s.normal_B},
                       s.reach_m};
      const std::optional<MeetingPlane> meeting = meeting_plane(a, b, bent_.X_AB);
      if (!meeting) return false;
      const PlaneId in_b = name_in_b(i);
      PlaneId name = fresh(in_b);  // on b's side
      if (!meeting->ends_a) name = meeting->of_wall.opposite();
      if (!meeting->ends_b) name = fresh(meeting->of_wall);
      moved_names_[in_b] = name;
      if (meeting->ends_a) end(a, meeting->planes.a, name.opposite(), 0);
      if (meeting->ends_b) end(b, meeting->planes.b, in_b, 1);
      ends_.emplace_back(meeting->ends_a, meeting->ends_b);
    }
    return true;
  }

  /// A convex that is of two sections ends in both, one after the other: not yet.
  void end(const BentSide& side, const Plane& plane, PlaneId id, std::size_t which) {
    for (Ended& ended : end_side(side, plane, id)) {
      const bool once = ended_[which].emplace(ended.slot, std::move(ended.convex)).second;
      twice_ |= !once;
    }
  }

  /// Whether what ends overlaps nothing, and the world holds on to what it held.
  bool lets_end(const Structure& structure, int side) const {
    return !twice_ && std::ranges::all_of(ended_[side], [&](const auto& one) {
      const auto& [slot, convex] = one;
      const bool held = structure.anchored(slot) == 0 || anchors(structure, slot, convex) != 0;
      return held && structure.ghost_indices(slot).empty();
    });
  }

  static std::uint8_t anchors(const Structure& structure, ConvexSlot slot, const ConvexPtr& ended) {
    if (!ended) return 0;
    return inherited_anchors(structure.anchored(slot), structure.convex(slot)->box, ended->box);
  }

  /// Whether what one section ends on ends otherwise by another.
  bool wall_ends() const {
    const auto any = [&](std::span<const std::uint32_t> slots, const Endings& endings) {
      return std::ranges::any_of(slots,
                                 [&](auto slot) { return endings.contains(ConvexSlot(slot)); });
    };
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      if (!ends_[i].first && any(bent_.sections[i].slots_a, ended_[0])) return true;
      if (!ends_[i].second && any(bent_.sections[i].slots_b, ended_[1])) return true;
    }
    return false;
  }

  /// Into the rest frame of a, with names of its own: what lay in one plane with a before lies in
  /// another now.
  ConvexPtr moved(const Convex& convex) const {
    const auto renamed = [&](PlaneId id) -> PlaneId {
      if (id.none()) return id;
      const auto at = moved_names_.find(id);
      return at != moved_names_.end() ? at->second : fresh(id);
    };
    auto result = std::make_shared<Convex>(convex);
    result->polyhedron = transformed(convex.polyhedron, bent_.X_AB);
    for (ConvexPolyhedron::Face& face : result->polyhedron.faces) face.id = renamed(face.id);
    if (convex.visual) {
      auto visual = std::make_shared<PolygonMesh>(*convex.visual);
      const Quatf turn = bent_.X_AB.rotation.cast<float>();
      for (Vec3& vertex : visual->vertices) vertex = bent_.X_AB * vertex;
      for (Vec3f& normal : visual->corner_normals) normal = turn * normal;
      for (PolygonMesh::Face& face : visual->faces) {
        face.id = renamed(face.id);
        face.plane.normal = bent_.X_AB.rotation * face.plane.normal;
        face.plane.d -= face.plane.normal.dot(bent_.X_AB.position);
      }
      result->visual = std::move(visual);
    }
    const Mat3 turn = bent_.X_AB.rotation.toRotationMatrix();
    result->solid.centroid = bent_.X_AB * convex.solid.centroid;
    result->solid.second_moment = turn * convex.solid.second_moment * turn.transpose();
    result->box = bounds(result->polyhedron);
    result->X_RT = bent_.X_AB * convex.X_RT;
    return result;
  }

  /// What has ended weighs what it did, of each material; false if one has gone altogether.
  bool weigh_ends() {
    struct Volume {
      double before = 0, after = 0;
    };
    std::map<MaterialIndex, Volume> volumes;
    for (int side = 0; side < 2; ++side) {
      const Structure& structure = side == 0 ? bent_.a : bent_.b;
      for (const auto& [slot, convex] : ended_[side]) {
        const Convex& old = *structure.convex(slot);
        volumes[old.material].before += old.solid.volume_m3;
        if (convex) volumes[old.material].after += convex->solid.volume_m3;
      }
    }
    for (Endings& endings : ended_) {
      for (auto& [slot, convex] : endings) {
        if (!convex) continue;
        const Volume& volume = volumes[convex->material];
        convex = weighing(*convex, volume.before / volume.after);
      }
    }
    return std::ranges::all_of(volumes, [](const auto& one) { return one.second.after > 0; });
  }

  static ConvexPtr weighing(const Convex& convex, double share) {
    auto result = std::make_shared<Convex>(convex);
    result->solid.volume_m3 *= share;
    result->solid.second_moment *= share;
    return result;
  }

  std::uint32_t add(ConvexPtr convex, std::uint8_t anchors) {
    BreakEdit& edit = result_.edit;
    edit.added.push_back(std::move(convex));
    edit.added_anchors.push_back(anchors);
    return static_cast<std::uint32_t>(bent_.a.slot_count() + edit.added.size() - 1);
  }

  void take_in() {
    BreakEdit& edit = result_.edit;
    edit.changed = true;
    result_.slot_of_b.assign(bent_.b.slot_count(), ConvexSlot());
    for (const auto& [slot, convex] : ended_[0]) {
      edit.removed.push_back(slot);
      if (!convex) continue;
      fresh_.push_back(add(convex, anchors(bent_.a, slot, convex)));
    }
    bent_.b.for_each([&](ConvexSlot slot, const Convex& convex) {
      const auto ended = ended_[1].find(slot);
      if (ended == ended_[1].end()) {
        result_.slot_of_b[slot.value] = ConvexSlot(add(moved(convex), 0));
      } else if (ended->second) {
        fresh_.push_back(add(moved(*ended->second), 0));
      }
    });
    keep_bonds_of_b();
    find_new_bonds();
    keep_ghosts_of_b();
  }

  ConvexSlot place_in_a(std::uint32_t slot_b) const { return result_.slot_of_b[slot_b]; }

  void keep_bonds_of_b() {
    bent_.b.for_each([&](ConvexSlot slot, const Convex&) {
      const ConvexSlot a = place_in_a(slot.value);
      for (const Link& link : bent_.b.links(slot)) {
        const ConvexSlot b = place_in_a(link.other.value);
        if (a.none() || b.none() || a > b) continue;
        result_.edit.bonds.push_back({a.value, b.value, link.face, link.other_face, link.area_m2});
      }
    });
  }

  const ConvexPtr& convex(std::uint32_t slot) const {
    const std::uint32_t first = bent_.a.slot_count();
    return slot < first ? bent_.a.convex(ConvexSlot(slot)) : result_.edit.added[slot - first];
  }

  /// Those of what ends otherwise: with each other, and with what was beside it.
  void find_new_bonds() {
    std::map<std::uint32_t, std::vector<std::uint32_t>> beside;  // by slot of a, and faces
    for (int side = 0; side < 2; ++side) {
      const Structure& structure = side == 0 ? bent_.a : bent_.b;
      for (const auto& [slot, convex] : ended_[side]) {
        for (const Link& link : structure.links(slot)) {
          if (ended_[side].contains(link.other)) continue;
          const std::uint32_t other =
              side == 0 ? link.other.value : place_in_a(link.other.value).value;
          beside[other].push_back(link.other_face);
        }
      }
    }
    for (std::size_t i = 0; i < ends_.size(); ++i) {  // what they end on
      const BentSection& s = bent_.sections[i];
      for (std::size_t k = 0; k < s.slots_a.size(); ++k) {
        if (!ends_[i].first) beside[s.slots_a[k]].push_back(s.faces_a[k]);
        if (!ends_[i].second) beside[place_in_a(s.slots_b[k]).value].push_back(s.faces_b[k]);
      }
    }
    std::vector<std::uint32_t> slots;
    std::vector<ConvexPtr> convexes;
    std::vector<FaceEntry> faces;
    const auto next = [&] { return static_cast<std::uint32_t>(convexes.size()); };
    for (auto& [slot, of_slot] : beside) {
      std::ranges::sort(of_slot);
      of_slot.erase(std::unique(of_slot.begin(), of_slot.end()), of_slot.end());
      for (const std::uint32_t face : of_slot)
        faces.push_back(known_face(*convex(slot), next(), face));
      slots.push_back(slot);
      convexes.push_back(convex(slot));
    }
    for (const std::uint32_t slot : fresh_) {
      add_faces(*convex(slot), next(), faces);
      slots.push_back(slot);
      convexes.push_back(convex(slot));
    }
    for (Bond bond : find_contacts(convexes, faces)) {
      bond.a = slots[bond.a], bond.b = slots[bond.b];
      if (bond.a > bond.b) std::swap(bond.a, bond.b), std::swap(bond.face_a, bond.face_b);
      result_.edit.bonds.push_back(bond);
    }
  }

  void keep_ghosts_of_b() {
    std::set<std::uint32_t> numbers;
    bent_.b.for_each([&](ConvexSlot slot, const Convex&) {
      for (const std::uint32_t number : bent_.b.ghost_indices(slot)) numbers.insert(number);
    });
    for (const std::uint32_t number : numbers) {
      Ghost ghost = bent_.b.ghost(number);
      ghost.convex = moved(*ghost.convex);
      for (std::uint32_t& slot : ghost.of) slot = place_in_a(slot).value;
      result_.edit.ghosts.push_back(std::move(ghost));
    }
  }

  const BentPair& bent_;
  Endings ended_[2];
  bool twice_ = false;
  std::map<PlaneId, PlaneId> moved_names_;  ///< Of the planes in which b ends, once it is moved.
  /// Per section, whether either side ends there.
  std::vector<std::pair<bool, bool>> ends_;
  std::vector<std::uint32_t> fresh_;  ///< Slots of what ends otherwise, in a.
  Rejoined result_;
};

}  // namespace

Rejoined rejoin_bent(const BentPair& bent) { return Rejoining(bent).run(); }

}  // namespace sunder::fracture
