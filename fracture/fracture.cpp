#include "fracture/fracture.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <unordered_map>

#include "fracture/adjacency.h"
#include "fracture/connectivity.h"
#include "fracture/fragments.h"
#include "fracture/islands.h"

namespace sunder::fracture {
namespace {

/// Fragments and their neighbours, on their way into pieces. A node is a slot of the structure, or
/// from `slot_count()` on a fragment.
class Rubble {
 public:
  Rubble(const Structure& structure, const std::vector<std::uint32_t>& touched,
         const Fragments& fragments)
      : structure_(structure),
        touched_(touched),
        fragments_(fragments.all),
        first_fragment_(structure.slot_count()) {
    find_contacts_of_fragments();
  }

  BreakEdit edit();

 private:
  /// A contact with at least one fragment, by nodes.
  struct Contact {
    std::uint32_t a, b, face_a, face_b;
    double area_m2;
  };

  bool is_touched(std::uint32_t slot) const {
    return std::binary_search(touched_.begin(), touched_.end(), slot);
  }
  bool is_fragment(std::uint32_t node) const { return node >= first_fragment_; }
  const Fragment& fragment(std::uint32_t node) const { return fragments_[node - first_fragment_]; }
  std::uint32_t group(std::uint32_t node) const {
    return is_fragment(node) ? fragment(node).group : Fragment::kRest;
  }
  const ConvexPtr& convex(std::uint32_t node) const {
    return is_fragment(node) ? fragment(node).convex : structure_.convex(node);
  }

  void find_contacts_of_fragments();
  std::vector<std::vector<std::uint32_t>> find_pieces();
  void separate_rest(std::vector<std::vector<std::uint32_t>>& pieces);
  void join_groups(std::vector<std::vector<std::uint32_t>>& pieces) const;
  void keep_rest(BreakEdit& edit);
  Compound make_piece(const std::vector<std::uint32_t>& nodes) const;
  void expose(BreakPlan& plan) const;
  /// Piece (0: the structure) and index of a node, after the break.
  std::pair<std::uint32_t, std::uint32_t> place(std::uint32_t node) const {
    const auto it = places_.find(node);
    return it == places_.end() ? std::pair{0u, node} : it->second;
  }

  const Structure& structure_;
  const std::vector<std::uint32_t>& touched_;
  const std::vector<Fragment>& fragments_;
  std::uint32_t first_fragment_;
  std::vector<Contact> contacts_;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> rest_contacts_;
  std::vector<std::uint32_t> neighbours_;  ///< Slots beside touched ones.
  std::unordered_map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> places_;
};

void Rubble::find_contacts_of_fragments() {
  for (const std::uint32_t slot : touched_) {
    for (const Link& link : structure_.links(slot)) {
      if (!is_touched(link.other)) neighbours_.push_back(link.other);
    }
  }
  std::sort(neighbours_.begin(), neighbours_.end());
  neighbours_.erase(std::unique(neighbours_.begin(), neighbours_.end()), neighbours_.end());

  // Neighbours first, then fragments: the order of nodes.
  const auto first = static_cast<std::uint32_t>(neighbours_.size());
  std::vector<ConvexPtr> convexes;
  std::vector<FaceEntry> faces;
  for (std::uint32_t i = 0; i < first; ++i) {
    convexes.push_back(structure_.convex(neighbours_[i]));
    std::uint32_t last_face = 0xffffffff;
    for (const Link& link : structure_.links(neighbours_[i])) {
      if (!is_touched(link.other) || link.face == last_face) continue;
      last_face = link.face;
      faces.push_back({convexes.back()->polyhedron.faces[link.face].id, i, link.face, true});
    }
  }
  const auto same = [](const FaceEntry& x, const FaceEntry& y) {
    return std::tie(x.convex, x.face) == std::tie(y.convex, y.face);
  };
  std::sort(faces.begin(), faces.end(), [](const FaceEntry& x, const FaceEntry& y) {
    return std::tie(x.convex, x.face) < std::tie(y.convex, y.face);
  });
  faces.erase(std::unique(faces.begin(), faces.end(), same), faces.end());
  for (const Fragment& fragment : fragments_) {
    add_faces(fragment.convex->polyhedron, static_cast<std::uint32_t>(convexes.size()), faces);
    convexes.push_back(fragment.convex);
  }
  const auto node = [&](std::uint32_t i) {
    return i < first ? neighbours_[i] : first_fragment_ + i - first;
  };
  for (const Bond& bond : find_contacts(convexes, std::move(faces))) {
    contacts_.push_back({node(bond.a), node(bond.b), bond.face_a, bond.face_b, bond.area_m2});
  }
}

/// What comes off, as islands of one group: the rest's smaller islands, then groups in order.
std::vector<std::vector<std::uint32_t>> Rubble::find_pieces() {
  std::vector<std::vector<std::uint32_t>> pieces;
  separate_rest(pieces);
  join_groups(pieces);
  return pieces;
}

void Rubble::separate_rest(std::vector<std::vector<std::uint32_t>>& pieces) {
  for (const Contact& contact : contacts_) {
    if (group(contact.a) != Fragment::kRest || group(contact.b) != Fragment::kRest) continue;
    rest_contacts_[contact.a].push_back(contact.b);
    rest_contacts_[contact.b].push_back(contact.a);
  }
  std::vector<std::uint32_t> seeds = neighbours_;
  for (std::uint32_t i = 0; i < fragments_.size(); ++i) {
    if (fragments_[i].group == Fragment::kRest) seeds.push_back(first_fragment_ + i);
  }
  Separation rest = separate(seeds, [&](std::uint32_t node, const auto& visit) {
    if (const auto it = rest_contacts_.find(node); it != rest_contacts_.end()) {
      for (const std::uint32_t other : it->second) visit(other);
    }
    if (is_fragment(node)) return;
    for (const Link& link : structure_.links(node)) {
      if (!is_touched(link.other)) visit(link.other);
    }
  });
  std::size_t known = touched_.size(), largest = 0;
  for (std::size_t i = 0; i < rest.islands.size(); ++i) {
    for (const std::uint32_t node : rest.islands[i]) known += is_fragment(node) ? 0 : 1;
    if (rest.islands[i].size() > rest.islands[largest].size()) largest = i;
  }
  // Where nothing else is left, the largest island is the structure from now on.
  if (!rest.bulk && known == structure_.size() && !rest.islands.empty()) {
    rest.islands.erase(rest.islands.begin() + static_cast<std::ptrdiff_t>(largest));
  }
  pieces = std::move(rest.islands);
}

void Rubble::join_groups(std::vector<std::vector<std::uint32_t>>& pieces) const {
  std::vector<Bond> bonds;
  for (const Contact& contact : contacts_) {
    if (!is_fragment(contact.a) || !is_fragment(contact.b)) continue;
    if (group(contact.a) != group(contact.b)) continue;
    bonds.push_back({contact.a - first_fragment_, contact.b - first_fragment_, 0, 0, 0});
  }
  const std::vector<std::uint32_t> islands = find_islands(fragments_.size(), bonds);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> members;
  for (std::uint32_t i = 0; i < fragments_.size(); ++i) {
    if (fragments_[i].group == Fragment::kRest) continue;
    members[{fragments_[i].group, islands[i]}].push_back(first_fragment_ + i);
  }
  for (auto& [key, nodes] : members) pieces.push_back(std::move(nodes));
}

Compound Rubble::make_piece(const std::vector<std::uint32_t>& nodes) const {
  Compound piece;
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    const std::uint32_t node = nodes[i];
    piece.convexes.push_back(convex(node));
    piece.anchored.push_back(is_fragment(node) ? fragment(node).anchored
                                               : structure_.anchored(node));
    if (is_fragment(node)) continue;
    for (const Link& link : structure_.links(node)) {
      if (link.other < node || is_touched(link.other)) continue;
      piece.bonds.push_back(
          {i, place(link.other).second, link.face, link.other_face, link.area_m2});
    }
  }
  return piece;
}

/// What stays with the structure: fragments of the rest that did not come off get slots.
void Rubble::keep_rest(BreakEdit& edit) {
  for (std::uint32_t i = 0; i < fragments_.size(); ++i) {
    if (places_.count(first_fragment_ + i)) continue;
    const auto slot = structure_.slot_count() + static_cast<std::uint32_t>(edit.added.size());
    edit.added.push_back(fragments_[i].convex);
    edit.added_anchors.push_back(fragments_[i].anchored);
    places_[first_fragment_ + i] = {0, slot};
  }
}

void Rubble::expose(BreakPlan& plan) const {
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, double> exposed;
  for (const Contact& contact : contacts_) {
    const auto [piece_a, a] = place(contact.a);
    const auto [piece_b, b] = place(contact.b);
    if (piece_a == piece_b) continue;
    plan.new_area_m2 += contact.area_m2;
    exposed[{piece_a, a, contact.face_a}] += contact.area_m2;
    exposed[{piece_b, b, contact.face_b}] += contact.area_m2;
  }
  for (const auto& [where, area] : exposed) {
    plan.exposed.push_back({std::get<0>(where), std::get<1>(where), std::get<2>(where), area});
  }
}

BreakEdit Rubble::edit() {
  BreakEdit edit;
  const std::vector<std::vector<std::uint32_t>> pieces = find_pieces();
  for (std::uint32_t p = 0; p < pieces.size(); ++p) {
    for (std::uint32_t i = 0; i < pieces[p].size(); ++i) places_[pieces[p][i]] = {p + 1, i};
  }
  keep_rest(edit);
  edit.removed = touched_;
  for (const auto& nodes : pieces) {
    std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(edit.removed),
                 [&](std::uint32_t node) { return !is_fragment(node); });
  }
  std::sort(edit.removed.begin(), edit.removed.end());
  const bool stays = structure_.size() + edit.added.size() > edit.removed.size();
  edit.changed = pieces.size() + (stays ? 1 : 0) > 1;
  if (!edit.changed) return {};
  for (const auto& nodes : pieces) edit.loose.pieces.push_back(make_piece(nodes));
  for (const Contact& contact : contacts_) {
    const auto [piece_a, a] = place(contact.a);
    const auto [piece_b, b] = place(contact.b);
    if (piece_a != piece_b) continue;
    const Bond bond = a < b ? Bond{a, b, contact.face_a, contact.face_b, contact.area_m2}
                            : Bond{b, a, contact.face_b, contact.face_a, contact.area_m2};
    (piece_a == 0 ? edit.bonds : edit.loose.pieces[piece_a - 1].bonds).push_back(bond);
  }
  for (Compound& piece : edit.loose.pieces) sort_bonds(piece.bonds);
  expose(edit.loose);
  return edit;
}

BreakPlan unbroken(const Compound& compound) {
  BreakPlan plan;
  plan.pieces.push_back(compound);
  plan.untouched = static_cast<std::uint32_t>(compound.convexes.size());
  return plan;
}

}  // namespace

BreakEdit break_structure(const Structure& structure, const Pattern& pattern,
                          const Placement& placement, const ImpactSphere& sphere,
                          std::uint64_t event) {
  std::vector<std::uint32_t> touched = structure.touched(sphere);
  if (touched.empty()) return {};
  Box reach;
  for (const std::uint32_t slot : touched) reach.extend(structure.convex(slot)->box);
  const AlignedPattern aligned = align(pattern, placement, event, reach);
  const Fragments fragments = make_fragments(structure, touched, aligned, sphere);
  BreakEdit edit;
  if (!touched.empty()) edit = Rubble(structure, touched, fragments).edit();
  edit.loose.failed = fragments.failed;
  if (!edit.changed) return edit;
  edit.loose.debris_volume_m3 = fragments.debris_volume_m3;
  edit.loose.welded = fragments.welded;
  for (const Fragment& fragment : fragments.all) {
    edit.loose.untouched += fragment.convex == structure.convex(fragment.source) ? 1 : 0;
  }
  edit.loose.untouched += structure.size() - static_cast<std::uint32_t>(touched.size());
  return edit;
}

BreakPlan fracture(const Compound& compound, const Pattern& pattern, const Placement& placement,
                   const ImpactSphere& sphere, std::uint64_t event) {
  Structure structure(compound);
  BreakEdit edit = break_structure(structure, pattern, placement, sphere, event);
  if (!edit.changed) {
    BreakPlan plan = unbroken(compound);
    plan.failed = edit.loose.failed;
    return plan;
  }
  structure.apply(edit);
  BreakPlan plan = std::move(edit.loose);
  const bool is_gone = structure.size() == 0;
  if (!is_gone) plan.pieces.insert(plan.pieces.begin(), structure.compound());
  std::vector<std::uint32_t> index(structure.slot_count());
  for (std::uint32_t slot = 0, next = 0; slot < index.size(); ++slot) {
    index[slot] = next;
    next += structure.convex(slot) ? 1 : 0;
  }
  for (ExposedFace& face : plan.exposed) {
    if (face.piece == 0) face.convex = index[face.convex];
    if (is_gone) --face.piece;
  }
  return plan;
}

}  // namespace sunder::fracture
