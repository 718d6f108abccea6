#include "engine/model/bent_section.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "engine/base/check.h"

namespace sunder {
namespace {

// Distance of a mitre's tip from the centroid over the section's reach, at the largest bend, 75°.
constexpr double kMaxTipDistance = 4;
// Relative tolerance of areas of faces that cover each other.
constexpr double kAreaTolerance = 1e-6;
// Least share of its faces' area that a section must cover for the faces to end with it.
constexpr double kMinCoverage = 0.9;

/// True if a section covers all of the faces that it is on.
bool covers_faces(const BentSide& side) {
  SUNDER_CHECK(side.slots.size() == side.areas_m2.size());
  std::set<std::pair<std::uint32_t, std::uint32_t>> counted;
  double all_m2 = 0, bonds_m2 = 0;
  for (std::size_t i = 0; i < side.slots.size(); ++i) {
    const ConvexPolyhedron& convex = side.structure.convex(ConvexSlot(side.slots[i]))->polyhedron;
    bonds_m2 += side.areas_m2[i];
    if (counted.emplace(side.slots[i], side.faces[i]).second)
      all_m2 += face_area(convex, side.faces[i]);
  }
  return bonds_m2 > kMinCoverage * all_m2;
}

/// Returns the id of the plane of a wall's faces; none if they lie in several.
PlaneId plane_id_of(const BentSide& wall) {
  const auto id = [&](std::size_t i) {
    return wall.structure.convex(ConvexSlot(wall.slots[i]))->polyhedron.faces[wall.faces[i]].id;
  };
  for (std::size_t i = 1; i < wall.slots.size(); ++i)
    if (id(i) != id(0)) return {};
  return id(0);
}

class SideMitre {
 public:
  SideMitre(const BentSide& side, const Plane& midplane, PlaneId id)
      : side_(side), structure_(side.structure), midplane_(midplane), id_(id) {
    for (const std::uint32_t slot : side.slots) {
      const Box& box = structure_.convex(ConvexSlot(slot))->box;
      const double far = box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
      tolerance_m_ = std::max(tolerance_m_, 4e-15 * far);
    }
  }

  std::vector<Ended> run() {
    for (std::size_t i = 0; i < side_.slots.size(); ++i) {
      const ConvexSlot slot(side_.slots[i]);
      if (!results_.contains(slot)) end_column(slot, side_.faces[i]);
    }
    cut_behind();
    std::vector<Ended> all;
    for (auto& [slot, convex] : results_)
      if (convex != structure_.convex(slot)) all.push_back({slot, std::move(convex)});
    return all;
  }

 private:
  /// Returns the face of a convex that is most opposite to another.
  std::uint32_t opposite_face(const Convex& convex, std::uint32_t front) const {
    const auto& faces = convex.polyhedron.faces;
    const auto along = [&](const ConvexPolyhedron::Face& face) {
      return face.plane.normal.dot(faces[front].plane.normal);
    };
    return static_cast<std::uint32_t>(std::ranges::min_element(faces, {}, along) - faces.begin());
  }

  /// Returns the link to the convex behind another, if they share the whole of a face of both.
  const Link* link_behind(ConvexSlot slot, std::uint32_t front) const {
    const Convex& convex = *structure_.convex(slot);
    const std::uint32_t back = opposite_face(convex, front);
    const double area_m2 = face_area(convex.polyhedron, back);
    for (const Link& link : structure_.links(slot)) {
      if (link.face != back) continue;
      const Convex& other = *structure_.convex(link.other);
      const double other_m2 = face_area(other.polyhedron, link.other_face);
      const auto same = [&](double m2) {
        return std::abs(link.area_m2 - m2) <= kAreaTolerance * m2;
      };
      if (same(area_m2) && same(other_m2) && convex.is_internal() == other.is_internal() &&
          convex.material == other.material)
        return &link;
    }
    return nullptr;
  }

  bool crosses_midplane(const Convex& convex) const {
    return std::ranges::any_of(convex.polyhedron.vertices, [&](const Vec3& vertex) {
      return midplane_.distance(vertex) > tolerance_m_;
    });
  }

  /// Ends the column of convexes behind one face of the section at the midplane.
  void end_column(ConvexSlot slot, std::uint32_t front) {
    std::vector<ColumnCell> column;
    std::vector<ConvexSlot> slots;
    for (;;) {
      const Convex& convex = *structure_.convex(slot);
      if (!slots.empty() && !crosses_midplane(convex)) break;
      slots.push_back(slot);
      column.push_back({&convex.polyhedron, front});
      const Link* next = link_behind(slot, front);
      if (!next || results_.contains(next->other) || is_of_section(next->other)) break;
      front = next->other_face;
      slot = next->other;
    }
    for (const ConvexSlot gone : slots) results_[gone] = nullptr;
    ConvexPolyhedron result;
    const auto last = mitre(column, midplane_, id_, tolerance_m_, result, scratch_);
    if (!last) return;
    const Convex& parent = *structure_.convex(slots[*last]);
    std::shared_ptr<const PolygonMesh> visual = parent.visual;
    if (visual) {
      auto mesh = std::make_shared<PolygonMesh>();
      const PlaneId name = parent.polyhedron.faces[column[*last].front].id;
      const PlaneSide side =
          mitre(*visual, name, side_.end.along, midplane_, id_, tolerance_m_, *mesh, mesh_scratch_);
      if (side == PlaneSide::kOutside) return;
      if (side == PlaneSide::kCut) visual = std::move(mesh);
    }
    results_[slots[*last]] =
        make_convex(std::move(result), parent.material, std::move(visual), parent.X_RT);
    for (std::size_t i = *last + 1; i < slots.size(); ++i) results_.erase(slots[i]);
  }

  bool is_of_section(ConvexSlot slot) const {
    return std::ranges::find(side_.slots, slot.value) != side_.slots.end();
  }

  /// Cuts convexes beside and behind the columns at the midplane.
  void cut_behind() {
    std::vector<ConvexSlot> heap;
    const auto add_around = [&](ConvexSlot slot) {
      for (const Link& link : structure_.links(slot))
        if (!results_.contains(link.other)) heap.push_back(link.other);
    };
    for (const auto& [slot, convex] : results_) add_around(slot);
    for (std::size_t i = 0; i < heap.size(); ++i) {
      const ConvexSlot slot = heap[i];
      const ConvexPtr& convex = structure_.convex(slot);
      const double far_m = (convex->box.center() - side_.end.centroid).norm();
      if (results_.contains(slot) || far_m > kMaxTipDistance * side_.reach_m ||
          !crosses_midplane(*convex))
        continue;
      results_[slot] = cut(convex);
      if (results_[slot] != convex) add_around(slot);
    }
  }

  ConvexPtr cut(const ConvexPtr& convex) {
    ConvexPolyhedron result;
    const PlaneSide side =
        clip(convex->polyhedron, midplane_, id_, tolerance_m_, result, scratch_.clip);
    if (side == PlaneSide::kOutside) return nullptr;
    if (side == PlaneSide::kInside) return convex;
    std::shared_ptr<const PolygonMesh> visual = convex->visual;
    if (visual) {
      auto mesh = std::make_shared<PolygonMesh>();
      const PlaneSide of_mesh = clip(*visual, midplane_, id_, tolerance_m_, *mesh, mesh_scratch_);
      if (of_mesh == PlaneSide::kOutside) return nullptr;
      if (of_mesh == PlaneSide::kCut) visual = std::move(mesh);
    }
    return make_convex(std::move(result), convex->material, std::move(visual), convex->X_RT);
  }

  const BentSide& side_;
  const Structure& structure_;
  const Plane& midplane_;
  PlaneId id_;
  double tolerance_m_ = 0;
  MitreScratch scratch_;
  MeshClipScratch mesh_scratch_;
  std::map<ConvexSlot, ConvexPtr> results_;
};

}  // namespace

std::optional<MeetingPlane> meeting_plane(const BentSide& a, const BentSide& b, const Pose& X_AB) {
  const bool covers_a = covers_faces(a), covers_b = covers_faces(b);
  if (!covers_a && !covers_b) return std::nullopt;
  if (covers_a && covers_b) {
    const std::optional<Midplane> middle = midplane(a.end, b.end, X_AB);
    return middle ? std::optional(MeetingPlane{*middle, true, true, {}}) : std::nullopt;
  }
  const Vec3 along_b_A = X_AB.rotation * b.end.along;
  MeetingPlane meeting;
  meeting.ends_a = covers_a, meeting.ends_b = covers_b;
  meeting.of_wall = plane_id_of(covers_a ? b : a);
  if (meeting.of_wall.none() || -a.end.along.dot(along_b_A) < kMinMitreCosine) return std::nullopt;
  const Vec3 normal_A = covers_a ? Vec3(-along_b_A) : a.end.along;
  const Vec3 point_A = covers_a ? X_AB * b.end.centroid : a.end.centroid;
  const Pose X_BA = X_AB.inverse();
  meeting.planes = {Plane::through(point_A, normal_A),
                    Plane::through(X_BA * point_A, X_BA.rotation * -normal_A)};
  return meeting;
}

std::vector<Ended> end_side(const BentSide& side, const Plane& midplane, PlaneId id) {
  return SideMitre(side, midplane, id).run();
}

}  // namespace sunder
