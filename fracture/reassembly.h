// Steps 4 and 5 of a fracture: fragments are put together as pieces (paper 3.1).
//
// Read first: edit(). The constructor finds contacts, edit() finds the islands.
#pragma once

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "engine/model/breaker.h"
#include "fracture/adjacency/adjacency.h"
#include "fracture/cut/fragments.h"

namespace sunder::fracture {

/// Assembles fragments and their neighbours into pieces. A node is a slot of the structure if it is
/// below `slot_count()`, and fragment number node − slot_count() otherwise.
class Reassembly {
 public:
  /// `fragments` are the parts into which the convexes in slots `touched`, ascending, within
  /// `sphere` were cut. All four arguments must outlive the object.
  Reassembly(const Structure& structure, const std::vector<ConvexSlot>& touched,
             const Fragments& fragments, const ImpactSphere& sphere);

  /// Returns the edit that turns the structure into the remaining structure and its pieces.
  BreakEdit edit();

 private:
  /// Contact with at least one fragment, between nodes.
  struct Contact {
    std::uint32_t a, b, face_a, face_b;
    double area_m2;
  };
  /// Contact of a ghost with a convex or another ghost. It adds `sign` times its area to that of
  /// the ghosts' convexes, so that area counts once where convexes overlap.
  struct Correction {
    Contact contact;
    int sign;
  };

  bool is_touched(ConvexSlot slot) const {
    return std::binary_search(touched_.begin(), touched_.end(), slot);
  }
  bool is_any_touched(const Ghost& ghost) const {
    return std::any_of(ghost.of.begin(), ghost.of.end(),
                       [&](std::uint32_t slot) { return is_touched(ConvexSlot(slot)); });
  }
  bool is_fragment(std::uint32_t node) const { return node >= first_fragment_; }
  const Fragment& fragment(std::uint32_t node) const { return fragments_[node - first_fragment_]; }
  std::uint32_t group(std::uint32_t node) const {
    return is_fragment(node) ? fragment(node).group : Fragment::kRest;
  }
  /// Returns the node of the convex at `index`, where neighbours are counted first, then fragments.
  std::uint32_t node_of(std::uint32_t index) const {
    const auto neighbours = static_cast<std::uint32_t>(neighbours_.size());
    return index < neighbours ? neighbours_[index].value : first_fragment_ + index - neighbours;
  }
  const ConvexPtr& convex(std::uint32_t node) const {
    return is_fragment(node) ? fragment(node).convex : structure_.convex(ConvexSlot(node));
  }

  /// Returns the material that cracks on the side of `node` in a contact with `other`.
  MaterialIndex cracked(std::uint32_t node, std::uint32_t other) const {
    const MaterialIndex own = convex(node)->material;
    return sphere_.is_unbreakable(own) ? convex(other)->material : own;
  }

  void find_contacts_of_fragments();
  void find_neighbours();
  void add_neighbours(std::vector<ConvexPtr>& convexes, std::vector<FaceEntry>& faces) const;
  std::vector<Ghost> add_ghosts(std::vector<ConvexPtr>& convexes,
                                std::vector<FaceEntry>& faces) const;
  void add_correction(const Bond& bond, std::uint32_t convexes, const std::vector<Ghost>& ghosts);
  void link_rest(std::uint32_t a, std::uint32_t b);
  std::vector<std::vector<std::uint32_t>> find_pieces();
  void find_islands_of_rest(std::vector<std::vector<std::uint32_t>>& pieces);
  void find_islands_of_groups(std::vector<std::vector<std::uint32_t>>& pieces) const;
  void keep_rest(BreakEdit& edit);
  Compound make_piece(const std::vector<std::uint32_t>& nodes) const;
  void place_ghosts(BreakEdit& edit) const;
  void expose(BreakPlan& plan) const;
  /// Returns the piece of a node after the break (0: the remaining structure), and its index there.
  std::pair<std::uint32_t, std::uint32_t> place(std::uint32_t node) const {
    const auto it = places_.find(node);
    return it == places_.end() ? std::pair{0u, node} : it->second;
  }

  const Structure& structure_;
  const std::vector<ConvexSlot>& touched_;
  const std::vector<Fragment>& fragments_;
  const std::vector<Ghost>& ghosts_;  ///< Ghosts that were cut, by nodes.
  const ImpactSphere& sphere_;
  std::uint32_t first_fragment_;
  std::vector<Contact> contacts_;
  std::vector<Correction> corrections_;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> rest_contacts_;
  /// Untouched slots that have a contact or a ghost with a touched one; ascending.
  std::vector<ConvexSlot> neighbours_;
  std::unordered_map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> places_;
};

}  // namespace sunder::fracture
