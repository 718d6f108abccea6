#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "engine/model/frame.h"

namespace sunder {
namespace {

std::shared_ptr<const Mesh> mesh() { return std::make_shared<const Mesh>(); }

std::vector<std::size_t> kept(const MeshStore& store) {
  std::vector<std::size_t> all;
  store.for_each([&](std::size_t i) { all.push_back(i); });
  return all;
}

TEST(MeshStore, KeepsIndicesWhenMeshesAreReleased) {
  MeshStore store;
  std::vector<std::weak_ptr<const Mesh>> meshes;
  for (int i = 0; i < 200; ++i) {
    store.push_back(mesh());
    meshes.push_back(store[store.size() - 1]);
  }
  std::vector<std::uint32_t> released;
  for (std::uint32_t i = 3; i < 198; ++i)
    if (i != 100) released.push_back(i);
  store.release(released);
  EXPECT_EQ(store.size(), 200u);
  EXPECT_EQ(kept(store), (std::vector<std::size_t>{0, 1, 2, 100, 198, 199}));
  for (std::size_t i = 0; i < meshes.size(); ++i) EXPECT_EQ(store[i], meshes[i].lock()) << i;
  EXPECT_TRUE(meshes[50].expired());
  EXPECT_EQ(store[50], nullptr);
  store.push_back(mesh());
  EXPECT_EQ(kept(store).back(), 200u);
  store.release(std::vector<std::uint32_t>{0, 1, 2, 100, 198, 199, 200});
  EXPECT_TRUE(kept(store).empty());
  EXPECT_EQ(store.size(), 201u);
}

TEST(MeshStore, CopiesDoNotSeeEachOthersChanges) {
  MeshStore store;
  for (int i = 0; i < 100; ++i) store.push_back(mesh());
  const MeshStore before = store;
  store.release(std::vector<std::uint32_t>{5, 70});
  MeshStore other = before;
  other.push_back(mesh());
  EXPECT_EQ(kept(before).size(), 100u);
  EXPECT_EQ(kept(store).size(), 98u);
  EXPECT_EQ(kept(other).size(), 101u);
  EXPECT_NE(before[5], nullptr);
  EXPECT_EQ(before[6], store[6]);
  EXPECT_EQ(before.size(), 100u);
}

}  // namespace
}  // namespace sunder
