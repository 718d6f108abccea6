#include "engine/world/actors/meshes.h"

#include <algorithm>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/base/state_checks.h"
#include "engine/model/piece_mesh.h"

namespace sunder {
namespace {

constexpr std::size_t kFewest = 128;  // meshes, or requests, among which unneeded ones are sought

}  // namespace

MeshIndex Meshes::add(std::shared_ptr<const Mesh> mesh) {
  store_.push_back(std::move(mesh));
  ++kept_;
  return MeshIndex(store_.size() - 1);
}

const char* Meshes::wrong_field(const Actors& actors) const {
  std::size_t kept = 0;
  store_.for_each([&](std::size_t) { ++kept; });
  if (kept_ != kept) return "kept_";
  if (!all_below(unused_, store_.size()) || !std::ranges::is_sorted(unused_)) return "unused_";
  for (const Pending& one : pending_) {
    const Actor* actor = actors.find(one.key);
    if (!actor) continue;
    if (one.slot.value >= actor->meshes.size()) return "pending_";
    if (actor->meshes[one.slot.value] == kMeshPending && !actor->structure.has(one.slot))
      return "pending_";
  }
  return nullptr;
}

bool Meshes::is_needed(const Actors& actors, const Pending& one) {
  const Actor* actor = actors.find(one.key);
  return actor && actor->meshes[one.slot.value] == kMeshPending;
}

void Meshes::tidy(const Actors& actors, std::span<const MeshIndex> others) {
  if (kept_ > most_) free_unused(actors, others);
  if (pending_.size() <= most_pending_) return;
  std::erase_if(pending_, [&](const Pending& one) { return !is_needed(actors, one); });
  most_pending_ = 2 * pending_.size() + kFewest;
}

/// Frees the meshes that are unused now and were at the last search, one step ago: searches come in
/// pairs. So the meshes of a frame live in the frame after it, between which a renderer
/// interpolates.
void Meshes::free_unused(const Actors& actors, std::span<const MeshIndex> others) {
  std::vector<std::uint8_t> used(store_.size(), 0);
  const auto use = [&](MeshIndex mesh) {
    if (!mesh.none() && mesh != kMeshPending) used[mesh.value] = 1;
  };
  for (const Actor& actor : actors) std::ranges::for_each(actor.meshes, use);
  std::ranges::for_each(others, use);
  std::vector<std::uint32_t> unused, released;
  store_.for_each([&](std::size_t i) {
    if (used[i] != 0) return;
    const auto mesh = static_cast<std::uint32_t>(i);
    (std::ranges::binary_search(unused_, mesh) ? released : unused).push_back(mesh);
  });
  store_.release(released);
  kept_ -= released.size();
  unused_ = std::move(unused);
  searched_ = !searched_;
  if (!searched_) most_ = kept_ + kept_ / 4 + kFewest;
}

void Meshes::add_to(std::span<Actor> actors, const DrawnConvexes& old) {
  for (Actor& actor : actors) {
    actor.hidden = hidden_faces(actor.structure, actor.structure.slots());
    actor.meshes.assign(actor.structure.slot_count(), kMeshPending);
    actor.structure.for_each([&](ConvexSlot slot, const Convex& convex) {
      MeshIndex& mesh = actor.meshes[slot.value];
      const auto known = old.find(&convex);
      if (known != old.end() && known->second.hidden == actor.hidden[slot.value]) {
        mesh = known->second.mesh;
      }
      if (mesh == kMeshPending) pending_.push_back({actor.key, slot});
    });
  }
}

void Meshes::update(Actor& actor, std::span<const ConvexSlot> slots) {
  std::vector<std::vector<std::uint8_t>> hidden = hidden_faces(actor.structure, slots);
  actor.hidden.resize(actor.structure.slot_count());
  actor.meshes.resize(actor.structure.slot_count());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    std::vector<std::uint8_t>& before = actor.hidden[slots[i].value];
    if (before == hidden[i]) continue;
    before = std::move(hidden[i]);
    actor.meshes[slots[i].value] = kMeshPending;
    pending_.push_back({actor.key, slots[i]});
  }
}

void Meshes::override_mesh(Actor& actor, ConvexSlot slot, std::shared_ptr<const Mesh> mesh) {
  MeshIndex& shown = actor.meshes[slot.value];
  if (mesh) {
    shown = add(std::move(mesh));
  } else if (shown != kMeshPending) {
    shown = kMeshPending;
    pending_.push_back({actor.key, slot});
  }
}

/// Returns, for each request, the index of the first with the same convex and hidden faces: copies
/// of a solid share their convexes, so that they can share the memory of meshes as well.
std::vector<std::size_t> Meshes::find_first_alike(std::span<const Pending> todo,
                                                  const Actors& actors) {
  const auto hidden = [&](const Pending& one) -> const std::vector<std::uint8_t>& {
    return actors.find(one.key)->hidden[one.slot.value];
  };
  std::vector<std::size_t> first(todo.size());
  std::unordered_map<const Convex*, std::size_t> of_convex;
  for (std::size_t i = 0; i < todo.size(); ++i) {
    const Convex* convex = actors.find(todo[i].key)->structure.convex(todo[i].slot).get();
    const std::size_t known = of_convex.try_emplace(convex, i).first->second;
    first[i] = hidden(todo[known]) == hidden(todo[i]) ? known : i;
  }
  return first;
}

void Meshes::draw(Actors& actors) {
  std::vector<Pending> todo = std::exchange(pending_, {});
  std::ranges::sort(todo);
  todo.erase(std::unique(todo.begin(), todo.end()), todo.end());
  std::erase_if(todo, [&](const Pending& one) { return !is_needed(actors, one); });
  const std::vector<std::size_t> first = find_first_alike(todo, actors);
  std::vector<std::shared_ptr<const Mesh>> made(todo.size());
  for_chunks(todo.size(), 8, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      if (first[i] != i) continue;
      const Actor& actor = *actors.find(todo[i].key);
      const ConvexSlot slot = todo[i].slot;
      made[i] = make_mesh(*actor.structure.convex(slot), actor.hidden[slot.value]);
    }
  });
  for (std::size_t i = 0; i < todo.size(); ++i) {
    MeshIndex& mesh = actors.find(todo[i].key)->meshes[todo[i].slot.value];
    mesh = made[first[i]] ? add(made[first[i]]) : MeshIndex();
  }
}

}  // namespace sunder
