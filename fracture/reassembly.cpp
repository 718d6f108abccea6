#include "fracture/reassembly.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "engine/base/check.h"
#include "fracture/adjacency/connectivity.h"
#include "fracture/adjacency/islands.h"

namespace sunder::fracture {

Reassembly::Reassembly(const Structure& structure, const std::vector<ConvexSlot>& touched,
                       const Fragments& fragments, const ImpactSphere& sphere)
    : structure_(structure),
      touched_(touched),
      fragments_(fragments.all),
      ghosts_(fragments.ghosts),
      sphere_(sphere),
      first_fragment_(structure.slot_count()) {
  find_contacts_of_fragments();
}

void Reassembly::find_neighbours() {
  const auto add = [&](ConvexSlot slot) {
    if (!is_touched(slot)) neighbours_.push_back(slot);
  };
  for (const ConvexSlot slot : touched_) {
    for (const Link& link : structure_.links(slot)) add(link.other);
    for (const std::uint32_t number : structure_.ghost_indices(slot)) {
      for (const std::uint32_t other : structure_.ghost(number).of) add(ConvexSlot(other));
    }
  }
  std::sort(neighbours_.begin(), neighbours_.end());
  neighbours_.erase(std::unique(neighbours_.begin(), neighbours_.end()), neighbours_.end());
}

/// Appends the neighbours and the faces in which they touched convexes that were cut.
void Reassembly::add_neighbours(std::vector<ConvexPtr>& convexes,
                                std::vector<FaceEntry>& faces) const {
  for (std::uint32_t i = 0; i < neighbours_.size(); ++i) {
    convexes.push_back(structure_.convex(neighbours_[i]));
    std::uint32_t last_face = 0xffffffff;
    for (const Link& link : structure_.links(neighbours_[i])) {
      if (!is_touched(link.other) || link.face == last_face) continue;
      last_face = link.face;
      faces.push_back(face_in_contact(*convexes.back(), i, link.face));
    }
  }
  const auto same = [](const FaceEntry& x, const FaceEntry& y) {
    return std::tie(x.convex, x.face) == std::tie(y.convex, y.face);
  };
  std::sort(faces.begin(), faces.end(), [](const FaceEntry& x, const FaceEntry& y) {
    return std::tie(x.convex, x.face) < std::tie(y.convex, y.face);
  });
  faces.erase(std::unique(faces.begin(), faces.end(), same), faces.end());
}

/// Appends the ghosts that count in sums of area, by nodes, and returns them: those that were cut,
/// with all faces, and those among neighbours, with faces only in planes that `faces` has already.
std::vector<Ghost> Reassembly::add_ghosts(std::vector<ConvexPtr>& convexes,
                                          std::vector<FaceEntry>& faces) const {
  std::vector<Ghost> ghosts = ghosts_;
  std::vector<std::uint32_t> known;
  for (const ConvexSlot slot : neighbours_) {
    for (const std::uint32_t number : structure_.ghost_indices(slot)) {
      if (!is_any_touched(structure_.ghost(number))) known.push_back(number);
    }
  }
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  for (const std::uint32_t number : known) ghosts.push_back(structure_.ghost(number));
  std::erase_if(ghosts, [](const Ghost& ghost) { return ghost.sign == 0; });
  if (ghosts.empty()) return ghosts;

  std::set<PlaneId> planes;
  for (const FaceEntry& face : faces) planes.insert(face.id);
  for (const Ghost& ghost : ghosts) {
    const auto index = static_cast<std::uint32_t>(convexes.size());
    const std::size_t first = faces.size();
    add_faces(*ghost.convex, index, faces);
    convexes.push_back(ghost.convex);
    if (is_fragment(ghost.of.back())) continue;
    const auto at = faces.begin() + static_cast<std::ptrdiff_t>(first);
    for (auto face = at; face != faces.end(); ++face) face->known = true;
    faces.erase(std::remove_if(at, faces.end(),
                               [&](const FaceEntry& face) { return !planes.contains(face.id); }),
                faces.end());
  }
  return ghosts;
}

void Reassembly::find_contacts_of_fragments() {
  find_neighbours();
  // The order is that of nodes: neighbours, then fragments; ghosts follow.
  std::vector<ConvexPtr> convexes;
  std::vector<FaceEntry> faces;
  add_neighbours(convexes, faces);
  for (const Fragment& fragment : fragments_) {
    add_faces(*fragment.convex, static_cast<std::uint32_t>(convexes.size()), faces);
    convexes.push_back(fragment.convex);
  }
  const auto count = static_cast<std::uint32_t>(convexes.size());
  const std::vector<Ghost> ghosts = add_ghosts(convexes, faces);
  for (const Bond& bond : find_contacts(convexes, faces)) {
    if (bond.b >= count) {
      add_correction(bond, count, ghosts);
    } else {
      contacts_.push_back(
          {node_of(bond.a), node_of(bond.b), bond.face_a, bond.face_b, bond.area_m2});
    }
  }
}

/// Records a contact of a ghost as one between the first convexes of the ghosts that have its face.
void Reassembly::add_correction(const Bond& bond, std::uint32_t convexes,
                                const std::vector<Ghost>& ghosts) {
  Correction correction{{0, 0, bond.face_a, bond.face_b, bond.area_m2}, 1};
  const auto resolve = [&](std::uint32_t index, std::uint32_t& node, std::uint32_t& face) {
    if (index < convexes) {
      node = node_of(index);
      return true;
    }
    const Ghost& ghost = ghosts[index - convexes];
    correction.sign *= ghost.sign;
    const PlaneId id = ghost.convex->polyhedron.faces[face].id;
    for (const std::uint32_t of : ghost.of) {
      const auto& own = convex(of)->polyhedron.faces;
      const auto at = std::find_if(own.begin(), own.end(), [&](auto& f) { return f.id == id; });
      if (at == own.end()) continue;
      node = of;
      face = static_cast<std::uint32_t>(at - own.begin());
      return true;
    }
    return false;
  };
  Contact& contact = correction.contact;
  if (resolve(bond.a, contact.a, contact.face_a) && resolve(bond.b, contact.b, contact.face_b)) {
    corrections_.push_back(correction);
  }
}

/// Returns the nodes of each piece that comes off: first the smaller islands of the rest, then the
/// islands of each group, in order of groups.
std::vector<std::vector<std::uint32_t>> Reassembly::find_pieces() {
  std::vector<std::vector<std::uint32_t>> pieces;
  find_islands_of_rest(pieces);
  find_islands_of_groups(pieces);
  return pieces;
}

void Reassembly::link_rest(std::uint32_t a, std::uint32_t b) {
  if (group(a) != Fragment::kRest || group(b) != Fragment::kRest) return;
  rest_contacts_[a].push_back(b);
  rest_contacts_[b].push_back(a);
}

void Reassembly::find_islands_of_rest(std::vector<std::vector<std::uint32_t>>& pieces) {
  for (const Contact& contact : contacts_) link_rest(contact.a, contact.b);
  for (const Ghost& ghost : ghosts_) {
    for (const std::uint32_t node : ghost.of) link_rest(ghost.of[0], node);
  }
  std::vector<std::uint32_t> seeds;
  for (const ConvexSlot slot : neighbours_) seeds.push_back(slot.value);
  for (std::uint32_t i = 0; i < fragments_.size(); ++i) {
    if (fragments_[i].group == Fragment::kRest) seeds.push_back(first_fragment_ + i);
  }
  Separation rest = separate(seeds, [&](std::uint32_t node, const auto& visit) {
    if (const auto it = rest_contacts_.find(node); it != rest_contacts_.end()) {
      for (const std::uint32_t other : it->second) visit(other);
    }
    if (is_fragment(node)) return;
    const ConvexSlot slot(node);
    for (const Link& link : structure_.links(slot)) {
      if (!is_touched(link.other)) visit(link.other.value);
    }
    for (const std::uint32_t number : structure_.ghost_indices(slot)) {
      for (const std::uint32_t other : structure_.ghost(number).of) {
        if (!is_touched(ConvexSlot(other))) visit(other);
      }
    }
  });
  std::size_t known = touched_.size(), largest = 0;
  for (std::size_t i = 0; i < rest.islands.size(); ++i) {
    for (const std::uint32_t node : rest.islands[i]) known += is_fragment(node) ? 0 : 1;
    if (rest.islands[i].size() > rest.islands[largest].size()) largest = i;
  }
  // If the search covered the whole rest, its largest island is the remaining structure.
  if (!rest.bulk && known == structure_.size() && !rest.islands.empty()) {
    rest.islands.erase(rest.islands.begin() + static_cast<std::ptrdiff_t>(largest));
  }
  pieces = std::move(rest.islands);
}

void Reassembly::find_islands_of_groups(std::vector<std::vector<std::uint32_t>>& pieces) const {
  std::vector<Bond> bonds;
  for (const Contact& contact : contacts_) {
    if (!is_fragment(contact.a) || !is_fragment(contact.b)) continue;
    if (group(contact.a) != group(contact.b)) continue;
    bonds.push_back({contact.a - first_fragment_, contact.b - first_fragment_, 0, 0, 0});
  }
  for (const Ghost& ghost : ghosts_) {
    if (!is_fragment(ghost.of[0])) continue;
    for (const std::uint32_t node : ghost.of) {
      bonds.push_back({ghost.of[0] - first_fragment_, node - first_fragment_, 0, 0, 0});
    }
  }
  const std::vector<std::uint32_t> islands = find_islands(fragments_.size(), bonds);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> members;
  for (std::uint32_t i = 0; i < fragments_.size(); ++i) {
    if (fragments_[i].group == Fragment::kRest) continue;
    members[{fragments_[i].group, islands[i]}].push_back(first_fragment_ + i);
  }
  for (auto& [key, nodes] : members) pieces.push_back(std::move(nodes));
}

Compound Reassembly::make_piece(const std::vector<std::uint32_t>& nodes) const {
  Compound piece;
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    const std::uint32_t node = nodes[i];
    piece.convexes.push_back(convex(node));
    if (is_fragment(node)) {
      piece.anchored.push_back(fragment(node).anchored);
      continue;
    }
    const ConvexSlot slot(node);
    piece.anchored.push_back(structure_.anchored(slot));
    for (const Link& link : structure_.links(slot)) {
      if (link.other < slot || is_touched(link.other)) continue;
      piece.bonds.push_back(
          {i, place(link.other.value).second, link.face, link.other_face, link.area_m2});
    }
    for (const std::uint32_t number : structure_.ghost_indices(slot)) {
      Ghost ghost = structure_.ghost(number);
      if (ghost.of[0] != node || is_any_touched(ghost)) continue;
      for (std::uint32_t& of : ghost.of) of = place(of).second;
      piece.ghosts.push_back(std::move(ghost));
    }
  }
  return piece;
}

/// Moves the ghosts that were cut to the piece of their convexes, which is one piece.
void Reassembly::place_ghosts(BreakEdit& edit) const {
  for (Ghost ghost : ghosts_) {
    const std::uint32_t piece = place(ghost.of[0]).first;
    for (std::uint32_t& of : ghost.of) {
      SUNDER_CHECK(place(of).first == piece);
      of = place(of).second;
    }
    std::sort(ghost.of.begin(), ghost.of.end());
    (piece == 0 ? edit.ghosts : edit.loose.pieces[piece - 1].ghosts).push_back(std::move(ghost));
  }
  for (Compound& piece : edit.loose.pieces) sort_ghosts(piece.ghosts);
}

/// Assigns slots to those fragments of the rest that stay in the structure.
void Reassembly::keep_rest(BreakEdit& edit) {
  for (std::uint32_t i = 0; i < fragments_.size(); ++i) {
    if (places_.count(first_fragment_ + i)) continue;
    const auto slot = structure_.slot_count() + static_cast<std::uint32_t>(edit.added.size());
    edit.added.push_back(fragments_[i].convex);
    edit.added_anchors.push_back(fragments_[i].anchored);
    places_[first_fragment_ + i] = {0, slot};
  }
}

void Reassembly::expose(BreakPlan& plan) const {
  using Side = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, MaterialIndex>;
  std::map<Side, double> exposed;
  const auto add = [&](const Contact& contact, double area) {
    const auto [piece_a, a] = place(contact.a);
    const auto [piece_b, b] = place(contact.b);
    if (piece_a == piece_b) return;
    plan.new_area_m2 += area;
    exposed[{piece_a, a, contact.face_a, cracked(contact.a, contact.b)}] += area;
    exposed[{piece_b, b, contact.face_b, cracked(contact.b, contact.a)}] += area;
  };
  for (const Contact& contact : contacts_) add(contact, contact.area_m2);
  for (const auto& [contact, sign] : corrections_) add(contact, sign * contact.area_m2);
  for (const auto& [side, area] : exposed) {
    const auto& [piece, index, face, material] = side;
    if (area > 0) plan.exposed.push_back({piece, index, face, area, material});
  }
}

BreakEdit Reassembly::edit() {
  BreakEdit edit;
  const std::vector<std::vector<std::uint32_t>> pieces = find_pieces();
  for (std::uint32_t p = 0; p < pieces.size(); ++p) {
    for (std::uint32_t i = 0; i < pieces[p].size(); ++i) places_[pieces[p][i]] = {p + 1, i};
  }
  keep_rest(edit);
  edit.removed = touched_;
  for (const auto& nodes : pieces) {
    for (const std::uint32_t node : nodes) {
      if (!is_fragment(node)) edit.removed.emplace_back(node);
    }
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
  place_ghosts(edit);
  expose(edit.loose);
  return edit;
}

}  // namespace sunder::fracture
