#include "engine/world/actors/meshes.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/model/piece_mesh.h"

namespace sunder {

MeshIndex Meshes::add(std::shared_ptr<const Mesh> mesh) {
  if (published_) {
    store_ = std::make_shared<MeshStore>(*store_);
    published_ = false;
  }
  store_->push_back(std::move(mesh));
  return MeshIndex(store_->size() - 1);
}

std::shared_ptr<const MeshStore> Meshes::publish() {
  published_ = true;
  return store_;
}

void Meshes::add_to(std::span<Actor> actors, const DrawnBefore& old) {
  std::vector<std::uint32_t> all;
  for (Actor& actor : actors) {
    const std::uint32_t count = actor.structure.slot_count();
    all.resize(count);
    std::iota(all.begin(), all.end(), 0u);
    actor.hidden = hidden_faces(actor.structure, all);
    actor.meshes.assign(count, kUndrawn);
    for (std::uint32_t c = 0; c < count; ++c) {
      const auto known = old.find(actor.structure.convex(c).get());
      if (known != old.end() && known->second.hidden == actor.hidden[c]) {
        actor.meshes[c] = known->second.mesh;
      }
      if (actor.meshes[c] == kUndrawn) undrawn_.push_back({actor.key, c});
    }
  }
}

void Meshes::renew(Actor& actor, std::span<const std::uint32_t> slots) {
  std::vector<std::vector<std::uint8_t>> hidden = hidden_faces(actor.structure, slots);
  actor.hidden.resize(actor.structure.slot_count());
  actor.meshes.resize(actor.structure.slot_count());
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (actor.hidden[slots[i]] == hidden[i]) continue;
    actor.hidden[slots[i]] = std::move(hidden[i]);
    actor.meshes[slots[i]] = kUndrawn;
    undrawn_.push_back({actor.key, slots[i]});
  }
}

void Meshes::draw(Actors& actors) {
  std::vector<Undrawn> todo = std::exchange(undrawn_, {});
  std::ranges::sort(todo);
  todo.erase(std::unique(todo.begin(), todo.end()), todo.end());
  std::erase_if(todo, [&](const Undrawn& one) {
    const Actor* actor = actors.find(one.key);
    return !actor || actor->meshes[one.slot] != kUndrawn;
  });
  std::vector<std::shared_ptr<const Mesh>> made(todo.size());
  for_chunks(todo.size(), 8, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Actor& actor = *actors.find(todo[i].key);
      made[i] = make_mesh(*actor.structure.convex(todo[i].slot), actor.hidden[todo[i].slot]);
    }
  });
  for (std::size_t i = 0; i < todo.size(); ++i) {
    MeshIndex& mesh = actors.find(todo[i].key)->meshes[todo[i].slot];
    mesh = made[i] ? add(std::move(made[i])) : MeshIndex();
  }
}

}  // namespace sunder
