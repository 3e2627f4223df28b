// Scenes that are changed after they were built: what is removed, hidden or changed leaves them as if built so.
#include <gtest/gtest.h>

#include <stdexcept>

#include "cpp/scene/small_nodes.h"
#include "cpp/support/expect_error.h"
#include "echopath/scene/scene.h"

namespace echopath::test_scene_changes {
namespace {

using test::expect_error;
using namespace testing;
using Invalid = std::invalid_argument;
using Names = std::vector<std::string>;

Transform at(double x) {
  Transform placement = Transform::Identity();
  placement.translation() = Vec3(x, 0, 0);
  return placement;
}

// Nodes 0 ground, 1 car, 2 car/body, 3 car/wheels, 4 car/wheels/left, 5 walker, 6 walker/arm; meshes at nodes 0, 2, 4, 5, 6.
Scene street() {
  Scene scene;
  scene.add(with_mesh("ground"));
  const int car = scene.add(group("car"));
  scene.add(with_mesh("body", car));
  const int wheels = scene.add(group("wheels", car));
  scene.add(with_mesh("left", wheels));
  const int walker = scene.add(with_mesh("walker"));
  scene.add(with_mesh("arm", walker));
  return scene;
}

int index_of(const Scene& scene, const std::string& name) { return scene.find(name).value(); }

void set_visible(Scene& scene, const std::string& name, bool visible) {
  const int index = index_of(scene, name);
  Node node = scene.nodes()[static_cast<size_t>(index)];
  node.visible = visible;
  scene.change(index, std::move(node));
}

std::shared_ptr<const Motion> first_second() {
  const std::vector<Vec3> there_and_back = {Vec3::Zero(), Vec3::UnitX(), Vec3::Zero()};
  return std::make_shared<KeyframeMotion>(std::vector<double>{0.0, 0.5, 1.0}, there_and_back, std::vector<Quaternion>{},
                                          Interpolation::kLinear);
}

TEST(SceneChanges, RemovalTakesWhatIsBelowAndNumbersTheRestWithoutGaps) {
  Scene scene = street();
  scene.remove(index_of(scene, "car"));
  EXPECT_EQ(scene.mesh_names(), (Names{"ground", "walker", "walker/arm"}));
  EXPECT_EQ(scene.nodes().size(), 3u);
  EXPECT_FALSE(scene.find("car").has_value());
  EXPECT_FALSE(scene.find("car/wheels/left").has_value());
  EXPECT_EQ(index_of(scene, "walker/arm"), 2);
  EXPECT_EQ(scene.nodes()[2].parent, 1);
  EXPECT_EQ(scene.meshes()[2].node, 2);
  EXPECT_EQ(scene.meshes()[2].object, 1);
  EXPECT_EQ(scene.num_triangles(), 3);
}

TEST(SceneChanges, ANameIsFreeAgainAfterRemoval) {
  Scene scene = street();
  scene.remove(index_of(scene, "car/wheels"));
  scene.add(with_mesh("wheels", index_of(scene, "car")));
  EXPECT_EQ(scene.mesh_names(), (Names{"ground", "car/body", "walker", "walker/arm", "car/wheels"}));
}

TEST(SceneChanges, WhatIsHiddenHasNoMeshIdNorHasWhatIsBelow) {
  Scene scene = street();
  set_visible(scene, "car", false);
  EXPECT_EQ(scene.mesh_names(), (Names{"ground", "walker", "walker/arm"}));
  EXPECT_EQ(scene.all_mesh_names(), (Names{"ground", "walker", "walker/arm", "car/body", "car/wheels/left"}));
  EXPECT_EQ(scene.num_triangles(), 3);
  EXPECT_TRUE(scene.find("car/body").has_value());
  EXPECT_FALSE(scene.takes_part(index_of(scene, "car/wheels/left")));
  EXPECT_TRUE(scene.takes_part(index_of(scene, "walker/arm")));
  EXPECT_EQ(scene.node_of(2).name, "walker/arm");
}

TEST(SceneChanges, WhatIsShownAgainHasTheMeshIdsOfBefore) {
  Scene scene = street();
  set_visible(scene, "car", false);
  set_visible(scene, "car/wheels", false);
  set_visible(scene, "car", true);
  EXPECT_EQ(scene.mesh_names(), (Names{"ground", "car/body", "walker", "walker/arm"}));
  set_visible(scene, "car/wheels", true);
  EXPECT_EQ(scene.mesh_names(), street().mesh_names());
}

TEST(SceneChanges, WhatIsAddedBelowAHiddenNodeIsHidden) {
  Scene scene = street();
  set_visible(scene, "car", false);
  scene.add(with_mesh("driver", index_of(scene, "car")));
  EXPECT_EQ(scene.meshes().size(), 3u);
  set_visible(scene, "car", true);
  EXPECT_EQ(scene.mesh_names().back(), "car/driver");
}

TEST(SceneChanges, MotionsOfHiddenNodesAreAskedForNothing) {
  Scene scene = street();
  Node wheels = scene.nodes()[3];
  wheels.motion = first_second();
  scene.change(3, wheels);
  EXPECT_EQ(scene.breakpoints(), std::vector<double>{0.5});
  EXPECT_TRUE(scene.is_anything_moving());
  expect_error<Invalid>([&] { scene.require_times(0.0, 5.0); }, {"car/wheels"});
  set_visible(scene, "car", false);
  EXPECT_TRUE(scene.breakpoints().empty());
  EXPECT_FALSE(scene.is_anything_moving());
  EXPECT_NO_THROW(scene.require_times(0.0, 5.0));
  EXPECT_EQ(world_from_nodes(scene, 5.0).size(), scene.nodes().size());
}

TEST(SceneChanges, AChangeKeepsNameAndParentAndTakesTheRest) {
  Scene scene = street();
  Node node = with_mesh("other");
  node.placement = at(7.0);
  node.smooth = true;
  scene.change(index_of(scene, "car/body"), node);
  const Node& body = scene.nodes()[2];
  EXPECT_EQ(body.name, "car/body");
  EXPECT_EQ(body.parent, 1);
  EXPECT_TRUE(body.smooth);
  EXPECT_EQ(body.mesh, node.mesh);
  EXPECT_EQ(world_vertices(scene, 1, 0.0)[0], Vec3(7, 0, 0));
  EXPECT_EQ(index_of(scene, "car/body"), 2);
}

TEST(SceneChanges, AMeshThatComesOrGoesRenumbersTheOthers) {
  Scene scene = street();
  scene.change(0, group("ground"));
  EXPECT_EQ(scene.mesh_names(), (Names{"car/body", "car/wheels/left", "walker", "walker/arm"}));
  scene.change(0, with_mesh("ground"));
  EXPECT_EQ(scene.mesh_names(), street().mesh_names());
}

TEST(SceneChanges, ARefusedChangeLeavesTheSceneAsItWas) {
  Scene scene = street();
  Node flat = scene.nodes()[2];
  flat.placement.linear().setZero();
  expect_error<Invalid>([&] { scene.change(2, flat); }, {"placement"});
  expect_error<Invalid>([&] { scene.change(7, scene.nodes()[2]); }, {"index"});
  expect_error<Invalid>([&] { scene.remove(-1); }, {"index"});
  EXPECT_EQ(scene.nodes()[2].name, "car/body");
  EXPECT_EQ(scene.nodes()[2].placement.matrix(), Transform::Identity().matrix());
  EXPECT_EQ(scene.mesh_names(), street().mesh_names());
}

TEST(SceneChanges, ACopyKeepsWhatItWas) {
  Scene scene = street();
  const Scene before = scene;
  Node walker = scene.nodes()[5];
  walker.placement = at(3.0);
  scene.change(5, walker);
  scene.remove(1);
  EXPECT_EQ(before.mesh_names(), street().mesh_names());
  EXPECT_EQ(world_vertices(before, 3, 0.0)[0], Vec3(0, 0, 0));
  EXPECT_EQ(world_vertices(scene, 1, 0.0)[0], Vec3(3, 0, 0));
}

}  // namespace
}  // namespace echopath::test_scene_changes
