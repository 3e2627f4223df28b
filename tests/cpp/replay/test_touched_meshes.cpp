// Which meshes of a scene a replay poses.
#include "echopath/replay/posed/touched_meshes.h"

#include <gtest/gtest.h>

#include "cpp/support/scenes.h"

namespace echopath::test_touched_meshes {
namespace {

using namespace testing;

// Four plates and, of one hit each, so many paths that meet the plate with ID 2. A hit on plate 1 belongs to no path.
Paths record(size_t num_paths) {
  auto scene = std::make_shared<Scene>();
  for (const char* name : {"first", "second", "third", "fourth"})
    add_rectangle(*scene, name, Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), lambert(1.0));
  Paths paths;
  paths.scene = std::move(scene);
  paths.hits = std::make_shared<const std::vector<Hit>>(std::vector<Hit>{{1, 0, 0.2f, 0.2f}, {2, 1, 0.2f, 0.2f}});
  paths.offsets.assign(num_paths, 1);
  paths.num_bounces.assign(num_paths, 1);
  return paths;
}

TEST(TouchedMeshes, AreThoseOfHitsAndPassages) {
  Paths paths = record(3);
  EXPECT_EQ(touched_meshes(paths).places->meshes, (std::vector<uint32_t>{2}));
  paths.passes.push_back({{3, 0, 0.1f, 0.1f}, 0});
  const MeshesToPose found = touched_meshes(paths);
  EXPECT_EQ(found.places->meshes, (std::vector<uint32_t>{2, 3}));
  EXPECT_FALSE(found.places->has(0) || found.places->has(1));
  EXPECT_EQ(found.patches.size(), 4u);
}

// To look at each of very many hits would take longer than what is saved.
TEST(TouchedMeshes, AreAllWherePathsAreMany) { EXPECT_EQ(touched_meshes(record(5000)).places->meshes.size(), 4u); }

}  // namespace
}  // namespace echopath::test_touched_meshes
