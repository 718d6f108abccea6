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
    if (!fit_to_meeting_planes() || is_support_changed() || !can_change(bent_.a, 0) ||
        !can_change(bent_.b, 1) || !conserve_mass())
      return {};
    merge_b();
    return std::move(result_);
  }

 private:
  using ChangedConvexes = std::map<ConvexSlot, ConvexPtr>;

  /// Returns a permanent, unique id for a plane that has the id `old` in b.
  PlaneId new_id(PlaneId old) const {
    return {combine(bent_.event, old.value >> 1) << 1 | (old.value & 1)};
  }
  /// Returns the id that the meeting plane of a section has in b until b is moved. It collides with
  /// none, as other ids are small or random.
  static PlaneId temporary_id(std::size_t section) { return {~std::uint64_t{2 * section}}; }

  /// Moves the ends of the convexes on both sides of each section to its meeting plane; returns
  /// false if a section is bent too far.
  bool fit_to_meeting_planes() {
    for (std::size_t i = 0; i < bent_.sections.size(); ++i) {
      const BentSection& s = bent_.sections[i];
      const BentSide a{bent_.a,  s.slots_a, s.faces_a, s.areas_m2, {s.centroid_A, s.normal_A},
                       s.reach_m};
      const BentSide b{bent_.b,  s.slots_b, s.faces_b, s.areas_m2, {s.centroid_B, s.normal_B},
                       s.reach_m};
      const std::optional<MeetingPlane> meeting = meeting_plane(a, b, bent_.X_AB);
      if (!meeting) return false;
      const PlaneId id_in_b = temporary_id(i);
      PlaneId id = new_id(id_in_b);  // On the side of b.
      if (!meeting->ends_a) id = meeting->of_wall.opposite();
      if (!meeting->ends_b) id = new_id(meeting->of_wall);
      final_ids_[id_in_b] = id;
      if (meeting->ends_a) change_side(a, meeting->planes.a, id.opposite(), 0);
      if (meeting->ends_b) change_side(b, meeting->planes.b, id_in_b, 1);
      ends_here_.emplace_back(meeting->ends_a, meeting->ends_b);
    }
    return true;
  }

  /// Two sections that change one convex are not supported: sets `changed_twice_`.
  void change_side(const BentSide& side, const Plane& plane, PlaneId id, std::size_t which) {
    for (Ended& ended : end_side(side, plane, id)) {
      const bool once = changed_[which].emplace(ended.slot, std::move(ended.convex)).second;
      changed_twice_ |= !once;
    }
  }

  /// Returns true if no changed convex overlaps another, and each anchored one keeps an anchor.
  bool can_change(const Structure& structure, int side) const {
    return !changed_twice_ && std::ranges::all_of(changed_[side], [&](const auto& one) {
      const auto& [slot, convex] = one;
      const bool held = structure.anchored(slot) == 0 || anchors(structure, slot, convex) != 0;
      return held && structure.ghost_indices(slot).empty();
    });
  }

  static std::uint8_t anchors(const Structure& structure, ConvexSlot slot, const ConvexPtr& ended) {
    if (!ended) return 0;
    return inherited_anchors(structure.anchored(slot), structure.convex(slot)->box, ended->box);
  }

  /// Returns true if a convex that one section leaves as it is is changed by another.
  bool is_support_changed() const {
    const auto any = [&](std::span<const std::uint32_t> slots, const ChangedConvexes& changed) {
      return std::ranges::any_of(slots,
                                 [&](auto slot) { return changed.contains(ConvexSlot(slot)); });
    };
    for (std::size_t i = 0; i < ends_here_.size(); ++i) {
      if (!ends_here_[i].first && any(bent_.sections[i].slots_a, changed_[0])) return true;
      if (!ends_here_[i].second && any(bent_.sections[i].slots_b, changed_[1])) return true;
    }
    return false;
  }

  /// Returns a convex of b in the rest frame of a with new plane ids: planes that a and b shared
  /// before the bend differ now.
  ConvexPtr moved(const Convex& convex) const {
    const auto renamed = [&](PlaneId id) -> PlaneId {
      if (id.none()) return id;
      const auto at = final_ids_.find(id);
      return at != final_ids_.end() ? at->second : new_id(id);
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

  /// Scales the changed convexes to the mass that each material had before; returns false if a
  /// material has nothing left.
  bool conserve_mass() {
    struct Volume {
      double before = 0, after = 0;
    };
    std::map<MaterialIndex, Volume> volumes;
    for (int side = 0; side < 2; ++side) {
      const Structure& structure = side == 0 ? bent_.a : bent_.b;
      for (const auto& [slot, convex] : changed_[side]) {
        const Convex& old = *structure.convex(slot);
        volumes[old.material].before += old.solid.volume_m3;
        if (convex) volumes[old.material].after += convex->solid.volume_m3;
      }
    }
    for (ChangedConvexes& changed : changed_) {
      for (auto& [slot, convex] : changed) {
        if (!convex) continue;
        const Volume& volume = volumes[convex->material];
        convex = with_scaled_mass(*convex, volume.before / volume.after);
      }
    }
    return std::ranges::all_of(volumes, [](const auto& one) { return one.second.after > 0; });
  }

  static ConvexPtr with_scaled_mass(const Convex& convex, double share) {
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

  void merge_b() {
    BreakEdit& edit = result_.edit;
    edit.changed = true;
    result_.slot_of_b.assign(bent_.b.slot_count(), ConvexSlot());
    for (const auto& [slot, convex] : changed_[0]) {
      edit.removed.push_back(slot);
      if (!convex) continue;
      changed_slots_.push_back(add(convex, anchors(bent_.a, slot, convex)));
    }
    bent_.b.for_each([&](ConvexSlot slot, const Convex& convex) {
      const auto ended = changed_[1].find(slot);
      if (ended == changed_[1].end()) {
        result_.slot_of_b[slot.value] = ConvexSlot(add(moved(convex), 0));
      } else if (ended->second) {
        changed_slots_.push_back(add(moved(*ended->second), 0));
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

  /// Finds the bonds of changed convexes with each other and with their neighbours.
  void find_new_bonds() {
    std::map<std::uint32_t, std::vector<std::uint32_t>> beside;  // Slot of a: faces.
    for (int side = 0; side < 2; ++side) {
      const Structure& structure = side == 0 ? bent_.a : bent_.b;
      for (const auto& [slot, convex] : changed_[side]) {
        for (const Link& link : structure.links(slot)) {
          if (changed_[side].contains(link.other)) continue;
          const std::uint32_t other =
              side == 0 ? link.other.value : place_in_a(link.other.value).value;
          beside[other].push_back(link.other_face);
        }
      }
    }
    for (std::size_t i = 0; i < ends_here_.size(); ++i) {  // Convexes that the changed ones end on.
      const BentSection& s = bent_.sections[i];
      for (std::size_t k = 0; k < s.slots_a.size(); ++k) {
        if (!ends_here_[i].first) beside[s.slots_a[k]].push_back(s.faces_a[k]);
        if (!ends_here_[i].second) beside[place_in_a(s.slots_b[k]).value].push_back(s.faces_b[k]);
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
        faces.push_back(face_in_contact(*convex(slot), next(), face));
      slots.push_back(slot);
      convexes.push_back(convex(slot));
    }
    for (const std::uint32_t slot : changed_slots_) {
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
  ChangedConvexes changed_[2];
  bool changed_twice_ = false;
  std::map<PlaneId, PlaneId> final_ids_;  ///< By temporary id.
  /// Per section: true if side a, or b, ends in the meeting plane.
  std::vector<std::pair<bool, bool>> ends_here_;
  std::vector<std::uint32_t> changed_slots_;  ///< Slots of changed convexes, in a.
  Rejoined result_;
};

}  // namespace

Rejoined rejoin_bent(const BentPair& bent) { return Rejoining(bent).run(); }

}  // namespace sunder::fracture
