#include "engine/model/frame.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <utility>

#include "engine/base/state_checks.h"

namespace sunder {

/// Returns a block of this store alone.
MeshStore::Block& MeshStore::changeable(std::size_t block) {
  std::shared_ptr<Block>& shared = blocks_[block];
  if (!shared) {
    shared = std::make_shared<Block>();
  } else if (shared.use_count() > 1) {
    shared = std::make_shared<Block>(*shared);
  } else {
    std::atomic_thread_fence(std::memory_order_acquire);  // after the last read of another thread
  }
  return *shared;
}

const char* Mesh::wrong_field() const {
  if (indices.size() % 3 != 0 || !all_below(indices, vertices.size())) return "indices";
  return uvs.empty() || uvs.size() == vertices.size() ? nullptr : "uvs";
}

const char* MeshStore::wrong_field() const {
  if (blocks_.size() != (size_ + kBlock - 1) / kBlock) return "blocks_";
  for (std::size_t i = size_; i < blocks_.size() * kBlock; ++i)
    if (blocks_.back() && (*blocks_.back())[i % kBlock]) return "size_";
  return nullptr;
}

void MeshStore::push_back(Pointer mesh) {
  if (size_ % kBlock == 0) blocks_.emplace_back();
  changeable(size_ / kBlock)[size_ % kBlock] = std::move(mesh);
  ++size_;
}

void MeshStore::release(std::span<const std::uint32_t> meshes) {
  for (std::size_t i = 0; i < meshes.size();) {
    const std::size_t number = meshes[i] / kBlock;
    Block& block = changeable(number);
    for (; i < meshes.size() && meshes[i] / kBlock == number; ++i) block[meshes[i] % kBlock] = {};
    const bool full = (number + 1) * kBlock <= size_;
    if (full && std::ranges::none_of(block, [](const Pointer& mesh) { return bool(mesh); }))
      blocks_[number] = nullptr;
  }
}

void pump(FrameSource& source, std::span<FrameSink* const> sinks) {
  while (const FramePtr frame = source.next()) {
    for (FrameSink* sink : sinks) sink->take(frame);
  }
  for (FrameSink* sink : sinks) sink->finish();
}

}  // namespace sunder
