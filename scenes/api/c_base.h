// Memory, errors and handles of all functions of the C interface. Internal to scenes/api.
//
// Read first: guard(), in which every function that can fail runs, then ask_world() and
// change_world().
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/check.h"
#include "engine/base/types.h"
#include "engine/model/checks/ranges.h"
#include "engine/model/frame.h"
#include "engine/world/world.h"
#include "scenes/api/sunder_c.h"

namespace sunder::scenes {

/// Returns memory of the functions set by sunder_set_allocator(). Throws std::bad_alloc.
void* hook_allocate(std::size_t bytes);
void hook_release(void* memory) noexcept;

/// Allocator of containers in memory of hook_allocate().
template <class T>
struct HookAllocator {
  using value_type = T;
  HookAllocator() = default;
  template <class U>
  HookAllocator(const HookAllocator<U>&) {}
  T* allocate(std::size_t count) {
    static_assert(alignof(T) <= alignof(std::max_align_t));
    if (count > SIZE_MAX / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(hook_allocate(count * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t) noexcept { hook_release(memory); }
  bool operator==(const HookAllocator&) const { return true; }
};
template <class T>
using Array = std::vector<T, HookAllocator<T>>;

/// An error of a call with its result; InputError stands for a result that depends on the call.
struct CallError {
  SunderResult result;
  std::string text;
};

/// Throws SUNDER_ERROR_ARGUMENT.
[[noreturn]] void refuse(const std::string& text);

/// Records the exception that is being handled as the last error of this thread, and returns its
/// result; `input_error` is that of InputError.
SunderResult record_exception(const char* call, SunderResult input_error) noexcept;

/// Runs the body of a call; no exception leaves.
template <class Body>
SunderResult guard(const char* call, SunderResult input_error, const Body& body) noexcept {
  try {
    body();
    return SUNDER_OK;
  } catch (...) {
    return record_exception(call, input_error);
  }
}

/// Values that mark definitions as filled by their default functions.
enum Cookie : std::uint32_t {
  kWorldCookie = 0x5d0e1001,
  kPatternCookie,
  kMaterialCookie,
  kPartCookie,
  kMeshCookie,
  kSolidCookie,
  kBallCookie,
  kJointCookie,
  kShotCookie,
  kBlastCookie,
  kDriveCookie,
  kQueryCookie,
};

/// Refuses a null pointer.
void need_pointer(const void* pointer, const char* name);
/// Refuses a definition that was not filled by a default function.
void need_cookie(std::uint32_t cookie, Cookie expected, const std::string& name,
                 const char* function);
template <class Def>
void need_def(const Def* def, Cookie expected, const char* name, const char* function) {
  need_pointer(def, name);
  need_cookie(def->cookie, expected, name, function);
}
/// Refuses a number out of a range, or NaN.
void need_number(double number, double low, double high, const std::string& name);
/// Refuses a vector with an element beyond `most`, or NaN.
void need_vector(const SunderVec3& vector, double most, const std::string& name);
/// Returns a string; empty for null.
inline std::string text_of(const char* text) { return text ? text : ""; }

/// Largest coordinate and speeds of what is added or moved.
inline constexpr double kMaxPosition_m = ranges::kPlace_m.high,
                        kMaxSpeed_m_s = ranges::kSpeed_m_s.high,
                        kMaxSpin_rad_s = ranges::kSpin_rad_s.high;
inline constexpr double kMaxImpulse_Ns = 1e15;

inline Vec3 vec(const SunderVec3& v) { return {v.x, v.y, v.z}; }
inline SunderVec3 vec(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Quat quat(const SunderQuat& q) { return {q.w, q.x, q.y, q.z}; }
inline SunderQuat quat(const Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }
inline Pose pose(const SunderPose& X) { return {vec(X.position), quat(X.rotation)}; }
inline SunderPose pose(const Pose& X) { return {vec(X.position), quat(X.rotation)}; }
inline BodyMotion motion(const SunderMotion& m) {
  return {pose(m.X_WR), vec(m.velocity_W), vec(m.angular_velocity_W)};
}
inline SunderMotion motion(const BodyMotion& m) {
  return {pose(m.X_WR), vec(m.velocity_W), vec(m.angular_velocity_W)};
}
inline BodyKey key_of(SunderBody body) { return BodyKey(std::size_t{body.key}); }
inline SunderBody body_of(BodyKey key) { return {key.value}; }
inline CollisionFilter filter_of(SunderFilter filter) { return {filter.category, filter.mask}; }
inline SunderFilter filter_of(CollisionFilter filter) { return {filter.category, filter.mask}; }
/// Copies a name into a buffer, cut off if it is longer.
void copy_name(const std::string& name, char (&buffer)[SUNDER_NAME_SIZE]);
/// Returns the number of elements of an array that is passed to the caller.
std::uint32_t count_of(std::size_t size);
template <class T>
const T* data_of(const Array<T>& array) {
  return array.empty() ? nullptr : array.data();
}

/// Returns the pattern of a definition; `base` is the one that it copies, or null.
PatternSpec pattern_of(const SunderPatternDef& def, const std::string& name,
                       const PatternSpec* base = nullptr);

/// Returns the built-in materials.
const std::vector<Material>& builtins();
/// Returns a built-in material for defaults; SUNDER_NO_MATERIAL if there is no memory for them.
SunderMaterial default_material(const char* name) noexcept;

/// Events of a step, as the caller sees them.
struct EventArrays {
  Array<SunderBreak> breaks;
  Array<SunderBody> children;
  Array<SunderHit> hits;
  Array<SunderBody> appeared, gone, fell_asleep, woke;
  Array<SunderJoint> joints_lost;
};

/// A frame, as the caller sees it.
struct FrameArrays {
  FramePtr frame;
  Array<SunderInstance> instances;
  Array<SunderDebris> debris;
  Array<SunderDust> dust;
  std::map<std::uint32_t, Array<SunderVertex>, std::less<>,
           HookAllocator<std::pair<const std::uint32_t, Array<SunderVertex>>>>
      vertices;  ///< Of the meshes that were asked for.
};

/// A world with what its handle keeps.
struct WorldEntry {
  /// Held by the call that uses the world; once more by calls that a query's `accepts` makes.
  std::recursive_mutex mutex;
  World world;
  bool incomplete = false;  ///< A call that changes the world did not end.
  std::optional<EventArrays> events;
  std::optional<FrameArrays> frame;

  Array<std::byte> saved;           ///< The last state that was saved.
  Array<SunderMaterial> materials;  ///< Handles of the first materials, by index.

  explicit WorldEntry(World made) : world(std::move(made)) {}
};

struct AssetEntry {
  Asset asset;
  Array<SunderMaterial> materials;  ///< Its materials that are not built in.
};

using WorldPtr = std::shared_ptr<WorldEntry>;
using AssetPtr = std::shared_ptr<AssetEntry>;

/// Returns the handle of a material of a world. A built-in material, also if the scene has changed
/// it, has its index; any other has a handle that stands for its values at its index in all worlds.
SunderMaterial material_of(WorldEntry& entry, MaterialIndex index);
/// Returns the index of a material of a world. Refuses a handle that is none of this world.
MaterialIndex index_in(WorldEntry& entry, SunderMaterial material, const std::string& name);
/// Returns the values of a material of any world, or of a built-in one as this world has it.
Material values_of(WorldEntry& entry, SunderMaterial material, const std::string& name);
/// Returns the index for which a handle stands in the worlds that have the material, which is added
/// to `own` if it is not built in. Refuses a handle that stands for nothing.
MaterialIndex index_of(SunderMaterial material, const std::string& name,
                       Array<SunderMaterial>& own);

SunderWorld add_world(WorldPtr world);
SunderAsset add_asset(AssetPtr asset);
/// Returns what a handle stands for. Throws SUNDER_ERROR_HANDLE, with the argument's name.
WorldPtr find_world(SunderWorld handle);
AssetPtr find_asset(SunderAsset handle);
/// Removes a handle and returns what it stood for.
WorldPtr take_world(SunderWorld handle);
AssetPtr take_asset(SunderAsset handle);
bool has_world(SunderWorld handle) noexcept;
bool has_asset(SunderAsset handle) noexcept;

/// Throws SUNDER_ERROR_HANDLE unless the world has the body.
void need_body(const WorldEntry& entry, SunderBody body, const char* name);
void need_joint(const WorldEntry& entry, SunderJoint joint, const char* name);
/// Throws SUNDER_ERROR_INTERNAL if a call did not end.
void need_complete(const WorldEntry& entry);

/// Runs the body of a call that asks a world, which no other call uses meanwhile.
template <class Body>
SunderResult ask_world(const char* call, SunderWorld handle, const Body& body) noexcept {
  return guard(call, SUNDER_ERROR_ARGUMENT, [&] {
    const WorldPtr entry = find_world(handle);
    const std::lock_guard lock(entry->mutex);
    need_complete(*entry);
    body(*entry);
  });
}

/// Runs the body of a call that changes a world. An error that is not about the arguments may leave
/// the world incomplete.
template <class Body>
SunderResult change_world(const char* call, SunderWorld handle, const Body& body) noexcept {
  return ask_world(call, handle, [&](WorldEntry& entry) {
    try {
      body(entry);
    } catch (const InputError&) {
      throw;
    } catch (const CallError&) {
      throw;
    } catch (...) {
      entry.incomplete = true;
      throw;
    }
  });
}

/// Fills an array of the caller's, as described in sunder_c.h, "Ask".
template <class Out, class Found, class Convert>
void fill(const Found& found, Out* out, std::uint32_t* count, const char* name,
          const Convert& convert) {
  need_pointer(count, "count");
  const std::uint32_t room = *count, needed = count_of(found.size());
  *count = needed;
  if (!out) return;
  if (room < needed)
    refuse(std::string(name) + " has room for " + std::to_string(room) + " elements; expected " +
           std::to_string(needed));
  for (std::uint32_t i = 0; i < needed; ++i) out[i] = convert(found[i]);
}

}  // namespace sunder::scenes
