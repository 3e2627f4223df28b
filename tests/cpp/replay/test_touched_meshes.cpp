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

// To look at each of very many hits would take longer than what is saved; but what moves may be refused at some times.
TEST(TouchedMeshes, AreAllWherePathsAreManyAndNothingMoves) {
  Paths paths = record(5000);
  EXPECT_EQ(touched_meshes(paths).places->meshes.size(), 4u);
  auto scene = std::make_shared<Scene>(*paths.scene);
  Node moving = node_with("moving", ellipsoid(Vec3::Zero(), Vec3::Ones(), 0), lambert(1.0));
  moving.motion = std::make_shared<const LinearMotion>(Vec3::UnitX());
  scene->add(moving);
  paths.scene = scene;
  EXPECT_EQ(touched_meshes(paths).places->meshes, (std::vector<uint32_t>{2}));
}

// Of what deforms, a patch is made of what is hit alone.
TEST(TouchedMeshes, HavePatchesOfWhatIsHitAlone) {
  Paths paths = record(1);
  auto scene = std::make_shared<Scene>(*paths.scene);
  const Surface ball = ellipsoid(Vec3::Zero(), Vec3::Ones(), 1);
  for (const char* name : {"hit", "not hit"}) {
    Node node = node_with(name, ball, lambert(1.0));
    node.deformation = std::make_shared<const VertexSequence>(
        std::vector<double>{0.0, 1.0}, std::vector<std::vector<Vec3>>{node.mesh->vertices(), node.mesh->vertices()});
    scene->add(node);
  }
  paths.scene = scene;
  paths.hits = std::make_shared<const std::vector<Hit>>(std::vector<Hit>{{0, 0, 0.2f, 0.2f}, {4, 3, 0.2f, 0.2f}});
  const MeshesToPose found = touched_meshes(paths);
  EXPECT_EQ(found.places->meshes, (std::vector<uint32_t>{4}));
  EXPECT_EQ(found.patches[4].original_vertex.size(), 3u);
  EXPECT_TRUE(found.patches[5].original_vertex.empty());
}

}  // namespace
}  // namespace echopath::test_touched_meshes
