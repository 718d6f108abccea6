#include "fracture/fracture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "fracture/adjacency.h"
#include "fracture/fragments.h"
#include "fracture/islands.h"
#include "fracture/polygon.h"

namespace sunder::fracture {
namespace {

double distance_to_box(const Vec3& point, const Box& box) {
  return (box.min - point).cwiseMax(point - box.max).cwiseMax(0.0).norm();
}

std::vector<std::uint32_t> find_touched(const Compound& compound, const ImpactSphere& sphere) {
  std::vector<std::uint32_t> touched;
  for (std::uint32_t i = 0; i < compound.convexes.size(); ++i) {
    if (sphere.touches(*compound.convexes[i])) touched.push_back(i);
  }
  return touched;
}

/// What a compound consists of after the cuts: convexes that stayed, then fragments.
class Rubble {
 public:
  Rubble(const Compound& parent, const std::vector<std::uint32_t>& touched, Fragments fragments)
      : parent_(parent) {
    std::vector<std::uint8_t> gone(parent.convexes.size(), 0);
    for (const std::uint32_t i : touched) gone[i] = 1;
    place_.assign(parent.convexes.size(), kGone);
    for (std::uint32_t i = 0; i < parent.convexes.size(); ++i) {
      if (gone[i]) continue;
      place_[i] = static_cast<std::uint32_t>(convexes_.size());
      add(parent.convexes[i], parent.anchored[i], Fragment::kRest, i);
    }
    stayed_ = static_cast<std::uint32_t>(convexes_.size());
    for (const Fragment& fragment : fragments.all) {
      add(fragment.convex, fragment.anchored, fragment.group, fragment.source);
    }
    find_bonds();
  }

  BreakPlan plan() const;

 private:
  static constexpr std::uint32_t kGone = 0xffffffff;

  void add(const ConvexPtr& convex, std::uint8_t anchored, std::uint32_t group,
           std::uint32_t source) {
    convexes_.push_back(convex);
    anchored_.push_back(anchored);
    groups_.push_back(group);
    sources_.push_back(source);
  }

  /// Bonds among what stayed are the parent's; those of fragments are looked for.
  void find_bonds() {
    std::vector<FaceEntry> faces;
    for (const Bond& bond : parent_.bonds) {
      const std::uint32_t a = place_[bond.a], b = place_[bond.b];
      if (a != kGone && b != kGone) {
        contacts_.push_back({a, b, bond.face_a, bond.face_b, bond.area_m2});
      } else if (a != kGone) {
        faces.push_back({face(a, bond.face_a).id, a, bond.face_a, true});
      } else if (b != kGone) {
        faces.push_back({face(b, bond.face_b).id, b, bond.face_b, true});
      }
    }
    const auto key = [](const FaceEntry& e) { return std::tie(e.convex, e.face); };
    std::sort(faces.begin(), faces.end(),
              [&](const FaceEntry& x, const FaceEntry& y) { return key(x) < key(y); });
    faces.erase(
        std::unique(faces.begin(), faces.end(),
                    [&](const FaceEntry& x, const FaceEntry& y) { return key(x) == key(y); }),
        faces.end());
    for (std::uint32_t i = stayed_; i < convexes_.size(); ++i) {
      add_faces(convexes_[i]->polyhedron, i, faces);
    }
    const std::vector<Bond> fresh = find_contacts(convexes_, std::move(faces));
    contacts_.insert(contacts_.end(), fresh.begin(), fresh.end());
  }

  const ConvexPolyhedron::Face& face(std::uint32_t convex, std::uint32_t face) const {
    return convexes_[convex]->polyhedron.faces[face];
  }

  /// The piece of each convex: pieces are islands of one group, the rest first.
  std::vector<std::uint32_t> assign_pieces(std::uint32_t& count) const;

  const Compound& parent_;
  std::vector<std::uint32_t> place_;  ///< Of the parent's convexes here; kGone where cut.
  std::uint32_t stayed_ = 0;
  std::vector<ConvexPtr> convexes_;
  std::vector<std::uint8_t> anchored_;
  std::vector<std::uint32_t> groups_;
  std::vector<std::uint32_t> sources_;
  std::vector<Bond> contacts_;  ///< Whatever the group.
};

std::vector<std::uint32_t> Rubble::assign_pieces(std::uint32_t& count) const {
  std::vector<Bond> bonds;
  std::copy_if(contacts_.begin(), contacts_.end(), std::back_inserter(bonds),
               [&](const Bond& bond) { return groups_[bond.a] == groups_[bond.b]; });
  const std::vector<std::uint32_t> islands = find_islands(convexes_.size(), bonds);
  // Group + 1 wraps around for the rest, which puts it first.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> order;
  for (std::size_t i = 0; i < islands.size(); ++i) order[{groups_[i] + 1, islands[i]}] = 0;
  count = 0;
  for (auto& [key, piece] : order) piece = count++;
  std::vector<std::uint32_t> piece_of(islands.size());
  for (std::size_t i = 0; i < islands.size(); ++i) {
    piece_of[i] = order[{groups_[i] + 1, islands[i]}];
  }
  return piece_of;
}

BreakPlan Rubble::plan() const {
  BreakPlan plan;
  std::uint32_t count = 0;
  const std::vector<std::uint32_t> piece_of = assign_pieces(count);
  plan.pieces.resize(count);
  std::vector<std::uint32_t> index_in_piece(convexes_.size());
  for (std::size_t i = 0; i < convexes_.size(); ++i) {
    Compound& piece = plan.pieces[piece_of[i]];
    index_in_piece[i] = static_cast<std::uint32_t>(piece.convexes.size());
    piece.convexes.push_back(convexes_[i]);
    piece.anchored.push_back(anchored_[i]);
    plan.untouched += convexes_[i] == parent_.convexes[sources_[i]] ? 1 : 0;
  }
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, double> exposed;
  for (const Bond& contact : contacts_) {
    const std::uint32_t a = index_in_piece[contact.a], b = index_in_piece[contact.b];
    const std::uint32_t piece_a = piece_of[contact.a], piece_b = piece_of[contact.b];
    if (piece_a == piece_b) {
      plan.pieces[piece_a].bonds.push_back({a, b, contact.face_a, contact.face_b, contact.area_m2});
      continue;
    }
    plan.new_area_m2 += contact.area_m2;
    exposed[{piece_a, a, contact.face_a}] += contact.area_m2;
    exposed[{piece_b, b, contact.face_b}] += contact.area_m2;
  }
  for (Compound& piece : plan.pieces) sort_bonds(piece.bonds);
  for (const auto& [where, area] : exposed) {
    plan.exposed.push_back({std::get<0>(where), std::get<1>(where), std::get<2>(where), area});
  }
  return plan;
}

BreakPlan unbroken(const Compound& compound) {
  BreakPlan plan;
  plan.pieces.push_back(compound);
  plan.untouched = static_cast<std::uint32_t>(compound.convexes.size());
  return plan;
}

}  // namespace

bool ImpactSphere::is_endless() const {
  return radius_m == std::numeric_limits<double>::infinity();
}

bool ImpactSphere::touches(const Convex& convex) const {
  if (is_endless()) return true;
  return distance_to_box(center_R, convex.box) <= radius_m &&
         distance(center_R, convex.polyhedron) <= radius_m;
}

BreakPlan fracture(const Compound& compound, const Pattern& pattern, const Placement& placement,
                   const ImpactSphere& sphere, std::uint64_t event) {
  const std::vector<std::uint32_t> touched = find_touched(compound, sphere);
  if (touched.empty()) return unbroken(compound);
  Box reach;
  for (const std::uint32_t i : touched) reach.extend(compound.convexes[i]->box);
  const AlignedPattern aligned = align(pattern, placement, event, reach);
  Fragments fragments = make_fragments(compound, touched, aligned, sphere);
  const double debris = fragments.debris_volume_m3;
  const std::uint32_t welded = fragments.welded, failed = fragments.failed;
  BreakPlan plan = Rubble(compound, touched, std::move(fragments)).plan();
  if (!plan.broke()) plan = unbroken(compound);
  plan.failed = failed;
  if (!plan.broke()) return plan;
  plan.debris_volume_m3 = debris;
  plan.welded = welded;
  return plan;
}

}  // namespace sunder::fracture
