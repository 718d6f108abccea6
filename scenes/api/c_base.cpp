#include "scenes/api/c_base.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <new>
#include <sstream>
#include <utility>

#include "engine/base/archive.h"
#include "scenes/load.h"

namespace sunder::scenes {
namespace {

struct Hooks {
  SunderAlloc allocate = nullptr;
  SunderFree release = nullptr;
  void* user = nullptr;
};

Hooks hooks;  // changed only while nothing is allocated
std::atomic<std::size_t> allocations = 0;

thread_local char last_error[1024] = "";

/// The things that handles stand for. A slot whose thing was removed is used again, with another
/// generation.
template <class Handle, class Entry>
class Table {
 public:
  using Pointer = std::shared_ptr<Entry>;

  Handle add(Pointer entry, std::uint32_t generation) {
    std::size_t index = 0;
    while (index < slots_.size() && slots_[index].entry) ++index;
    if (index == slots_.size()) slots_.emplace_back();
    slots_[index] = {generation, std::move(entry)};
    return {static_cast<std::uint32_t>(index), generation};
  }
  /// Returns null if the handle stands for nothing.
  Pointer find(Handle handle) const {
    if (handle.index >= slots_.size()) return nullptr;
    const Slot& slot = slots_[handle.index];
    return slot.generation == handle.generation ? slot.entry : nullptr;
  }
  Pointer take(Handle handle) {
    Pointer found = find(handle);
    if (found) slots_[handle.index] = {};
    return found;
  }
  bool empty() const {
    return std::ranges::none_of(slots_, [](const Slot& slot) { return slot.entry != nullptr; });
  }
  /// Returns all memory; the table is empty.
  void shrink() { Array<Slot>().swap(slots_); }

 private:
  struct Slot {
    std::uint32_t generation = 0;
    Pointer entry;
  };
  Array<Slot> slots_;
};

/// All handles of the process.
struct Handles {
  std::mutex mutex;
  std::uint32_t generation = 0;  ///< The last that was issued: 0 stands for none.
  Table<SunderWorld, WorldEntry> worlds;
  Table<SunderAsset, AssetEntry> assets;

  std::uint32_t next_generation() {
    if (++generation == 0) ++generation;
    return generation;
  }
};

/// Returns the handles, which are never destroyed: threads may use them while the program ends.
Handles& handles() {
  static Handles& all = *new Handles;
  return all;
}

std::string number_text(double number) {
  std::ostringstream out;
  out << number;
  return out.str();
}

[[noreturn]] void refuse_handle(const char* name, std::uint32_t index, std::uint32_t generation) {
  if (index == 0 && generation == 0)
    throw CallError{SUNDER_ERROR_HANDLE, std::string(name) + " is null"};
  throw CallError{SUNDER_ERROR_HANDLE, std::string(name) + " does not exist, or was destroyed"};
}

/// Writes the last error of this thread.
SunderResult record(const char* call, SunderResult result, const char* text) noexcept {
  // Messages of World begin with its own function, which has the name of the caller's.
  if (std::strncmp(text, "World::", 7) == 0 || std::strncmp(text, "Asset(): ", 9) == 0) {
    const char* end = std::strstr(text, "(): ");
    if (end) text = end + 4;
  }
  std::snprintf(last_error, sizeof last_error, "%s(): %s", call, text);
  return result;
}

}  // namespace

void* hook_allocate(std::size_t bytes) {
  void* memory = hooks.allocate ? hooks.allocate(bytes, hooks.user) : std::malloc(bytes);
  if (!memory) throw std::bad_alloc();
  ++allocations;
  return memory;
}

void hook_release(void* memory) noexcept {
  --allocations;
  hooks.release ? hooks.release(memory, hooks.user) : std::free(memory);
}

void refuse(const std::string& text) { throw CallError{SUNDER_ERROR_ARGUMENT, text}; }

SunderResult record_exception(const char* call, SunderResult input_error) noexcept {
  try {
    throw;
  } catch (const CallError& error) {
    return record(call, error.result, error.text.c_str());
  } catch (const InputError& error) {
    return record(call, input_error, error.what());
  } catch (const FileError& error) {
    return record(call, SUNDER_ERROR_FILE, error.what());
  } catch (const std::bad_alloc&) {
    return record(call, SUNDER_ERROR_MEMORY, "there is not enough memory");
  } catch (const std::length_error&) {
    return record(call, SUNDER_ERROR_MEMORY, "there is not enough memory");
  } catch (const std::exception& error) {
    return record(call, SUNDER_ERROR_INTERNAL, error.what());
  } catch (...) {
    return record(call, SUNDER_ERROR_INTERNAL, "an unknown error");
  }
}

void need_pointer(const void* pointer, const char* name) {
  if (!pointer) refuse(std::string(name) + " is null; expected a pointer");
}

void need_cookie(std::uint32_t cookie, Cookie expected, const std::string& name,
                 const char* function) {
  if (cookie != expected)
    refuse(name + " was not filled; expected a definition that began as the result of " + function +
           "()");
}

void need_number(double number, double low, double high, const std::string& name) {
  if (number >= low && number <= high) return;
  refuse(name + " is " + number_text(number) + "; expected a number from " + number_text(low) +
         " to " + number_text(high));
}

void need_vector(const SunderVec3& vector, double most, const std::string& name) {
  need_number(vector.x, -most, most, name + ".x");
  need_number(vector.y, -most, most, name + ".y");
  need_number(vector.z, -most, most, name + ".z");
}

void copy_name(const std::string& name, char (&buffer)[SUNDER_NAME_SIZE]) {
  std::snprintf(buffer, sizeof buffer, "%s", name.c_str());
}

std::uint32_t count_of(std::size_t size) {
  if (size > std::numeric_limits<std::uint32_t>::max()) throw std::bad_alloc();
  return static_cast<std::uint32_t>(size);
}

const std::vector<Material>& builtins() {
  static const std::vector<Material>& all = *new std::vector<Material>(builtin_materials());
  return all;
}

SunderMaterial default_material(const char* name) noexcept {
  try {
    const std::vector<Material>& all = builtins();
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i].name == name) return {static_cast<std::uint32_t>(i)};
  } catch (...) {
  }
  return {SUNDER_NO_MATERIAL};
}

namespace {

/// The materials that are not built in, of all worlds of the process: handles stand for them.
struct OwnMaterials {
  struct Known {
    MaterialIndex index;
    Material material;
  };
  std::mutex mutex;
  std::vector<Known> known;                 ///< By handle, from kFirstOwn on.
  std::map<std::string, std::size_t> find;  ///< By index and values.
};

constexpr std::uint32_t kFirstOwn = 1u << 16;

/// Returns the materials, which are never destroyed, as handles() are not.
OwnMaterials& own_materials() {
  static OwnMaterials& all = *new OwnMaterials;
  return all;
}

/// Returns what a handle stands for; none if that is a built-in material, or nothing.
std::optional<OwnMaterials::Known> find_own(SunderMaterial material) {
  OwnMaterials& all = own_materials();
  const std::lock_guard lock(all.mutex);
  if (material.index < kFirstOwn || material.index - kFirstOwn >= all.known.size())
    return std::nullopt;
  return all.known[material.index - kFirstOwn];
}

SunderMaterial handle_of(std::uint32_t index, Material material) {
  if (index < builtins().size() && builtins()[index].name == material.name) return {index};
  Archive bytes;
  bytes(index, material);
  const std::vector<std::byte> key = bytes.take();
  OwnMaterials& all = own_materials();
  const std::lock_guard lock(all.mutex);
  const auto [found, is_new] = all.find.try_emplace(
      std::string(reinterpret_cast<const char*>(key.data()), key.size()), all.known.size());
  if (is_new) all.known.push_back({MaterialIndex(std::size_t{index}), std::move(material)});
  return {kFirstOwn + count_of(found->second)};
}

}  // namespace

SunderMaterial material_of(WorldEntry& entry, MaterialIndex index) {
  const std::vector<Material>& materials = entry.world.materials();
  if (index.value >= materials.size()) return {SUNDER_NO_MATERIAL};
  for (std::size_t i = entry.materials.size(); i < materials.size(); ++i)
    entry.materials.push_back(handle_of(static_cast<std::uint32_t>(i), materials[i]));
  return entry.materials[index.value];
}

MaterialIndex index_in(WorldEntry& entry, SunderMaterial material, const std::string& name) {
  const std::optional<OwnMaterials::Known> own = find_own(material);
  const MaterialIndex index = own ? own->index : MaterialIndex(std::size_t{material.index});
  if (!index.none() && material_of(entry, index).index == material.index) return index;
  refuse(name + " has material " + std::to_string(material.index) +
         (own ? ", a material " + own->material.name + " of another world" : ", which is none") +
         "; expected a material of this world, from sunder_world_material() or "
         "sunder_world_add_material()");
}

Material values_of(WorldEntry& entry, SunderMaterial material, const std::string& name) {
  if (std::optional<OwnMaterials::Known> known = find_own(material)) return known->material;
  return entry.world.materials()[index_in(entry, material, name).value];
}

MaterialIndex index_of(SunderMaterial material, const std::string& name,
                       Array<SunderMaterial>& own) {
  if (material.index < builtins().size()) return MaterialIndex(std::size_t{material.index});
  const std::optional<OwnMaterials::Known> known = find_own(material);
  if (!known)
    refuse(name + " is " + std::to_string(material.index) +
           ", which stands for no material; expected one of sunder_builtin_material(), "
           "sunder_world_material() or sunder_world_add_material()");
  own.push_back(material);
  return known->index;
}

SunderWorld add_world(WorldPtr world) {
  const std::lock_guard lock(handles().mutex);
  return handles().worlds.add(std::move(world), handles().next_generation());
}

SunderAsset add_asset(AssetPtr asset) {
  const std::lock_guard lock(handles().mutex);
  return handles().assets.add(std::move(asset), handles().next_generation());
}

namespace {

/// Returns what `look(handles())` finds of a handle; refuses the handle if that is null.
template <class Handle, class Look>
auto look_up(const char* kind, Handle handle, const Look& look) {
  const std::lock_guard lock(handles().mutex);
  auto found = look(handles());
  if (!found) refuse_handle(kind, handle.index, handle.generation);
  return found;
}

}  // namespace

WorldPtr find_world(SunderWorld handle) {
  return look_up("world", handle, [&](auto& all) { return all.worlds.find(handle); });
}

AssetPtr find_asset(SunderAsset handle) {
  return look_up("asset", handle, [&](auto& all) { return all.assets.find(handle); });
}

WorldPtr take_world(SunderWorld handle) {
  return look_up("world", handle, [&](auto& all) { return all.worlds.take(handle); });
}

AssetPtr take_asset(SunderAsset handle) {
  return look_up("asset", handle, [&](auto& all) { return all.assets.take(handle); });
}

bool has_world(SunderWorld handle) noexcept {
  const std::lock_guard lock(handles().mutex);
  return handles().worlds.find(handle) != nullptr;
}

bool has_asset(SunderAsset handle) noexcept {
  const std::lock_guard lock(handles().mutex);
  return handles().assets.find(handle) != nullptr;
}

void need_body(const WorldEntry& entry, SunderBody body, const char* name) {
  if (entry.world.contains(key_of(body))) return;
  const std::string key = body.key == SUNDER_NO_KEY ? "SUNDER_NO_KEY" : std::to_string(body.key);
  throw CallError{SUNDER_ERROR_HANDLE,
                  std::string(name) + " has the key " + key + ", which no body of the world has"};
}

void need_joint(const WorldEntry& entry, SunderJoint joint, const char* name) {
  if (entry.world.contains(JointKey(std::size_t{joint.key}))) return;
  throw CallError{SUNDER_ERROR_HANDLE, std::string(name) + " has the key " +
                                           std::to_string(joint.key) +
                                           ", which no joint of the world has"};
}

void need_complete(const WorldEntry& entry) {
  if (entry.incomplete)
    throw CallError{SUNDER_ERROR_INTERNAL,
                    "world is incomplete, as an earlier call did not end; destroy it"};
}

}  // namespace sunder::scenes

using namespace sunder::scenes;

const char* sunder_result_name(SunderResult result) {
  switch (static_cast<int>(result)) {
    case SUNDER_OK:
      return "SUNDER_OK";
    case SUNDER_ERROR_HANDLE:
      return "SUNDER_ERROR_HANDLE";
    case SUNDER_ERROR_ARGUMENT:
      return "SUNDER_ERROR_ARGUMENT";
    case SUNDER_ERROR_INPUT:
      return "SUNDER_ERROR_INPUT";
    case SUNDER_ERROR_FILE:
      return "SUNDER_ERROR_FILE";
    case SUNDER_ERROR_MEMORY:
      return "SUNDER_ERROR_MEMORY";
    case SUNDER_ERROR_INTERNAL:
      return "SUNDER_ERROR_INTERNAL";
    default:
      return "an unknown result";
  }
}

const char* sunder_last_error() { return last_error; }

const char* sunder_version() { return SUNDER_C_VERSION; }

SunderResult sunder_set_allocator(SunderAlloc allocate, SunderFree release, void* user) {
  return guard("sunder_set_allocator", SUNDER_ERROR_ARGUMENT, [&] {
    if (!allocate != !release) refuse("one of allocate and release is null; expected both or none");
    const std::lock_guard lock(handles().mutex);
    if (!handles().worlds.empty() || !handles().assets.empty())
      refuse("there are worlds or assets; expected a call before the first is made");
    handles().worlds.shrink();
    handles().assets.shrink();
    if (allocations > 0) refuse("a world or asset is being destroyed; expected none");
    hooks = {allocate, release, user};
  });
}
