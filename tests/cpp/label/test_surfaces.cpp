#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cpp/label/hand_made_paths.h"
#include "cpp/support/boxes.h"
#include "cpp/support/expect_error.h"
#include "cpp/support/scenes.h"
#include "echopath/label/objects/surfaces.h"

namespace echopath::test_surfaces {
namespace {

using namespace testing;
using Names = std::vector<std::string>;

std::string error_of(const std::vector<NamedGlobs>& objects) {
  return test::error_text([&] { map_surfaces(*make_street(), objects); });
}

void add_group(Scene& scene, const std::string& name, int parent = -1) {
  Node node;
  node.name = name;
  node.parent = parent;
  scene.add(std::move(node));
}

// A square of that half width at a place, facing x.
void add_square(Scene& scene, const std::string& name, const Vec3& centre, double half, const Material& material,
                int parent = -1) {
  Node node;
  node.name = name;
  node.parent = parent;
  const Vec3 y(0, half, 0), z(0, 0, half);
  node.mesh = std::make_shared<const Mesh>(std::vector<Vec3>{centre - y - z, centre + y - z, centre + y + z, centre - y + z},
                                           std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
  node.material = std::make_shared<const Material>(material);
  scene.add(std::move(node));
}

TEST(SurfaceMap, FirstObjectTakesAMesh) {
  const SurfaceMap map = map_surfaces(*make_street(), {{"arm", {"*/left"}}, {"person", {"pedestrian"}}});
  EXPECT_EQ(map.names, (Names{"arm", "person", "street"}));
  EXPECT_EQ(map.num_objects, 2u);
  EXPECT_EQ(map.of_mesh, (std::vector<uint32_t>{2, 2, 2, 1, 0, 1}));
  EXPECT_EQ(map.meshes_of(1), (std::vector<uint32_t>{kTorso, kArmRight}));
}

TEST(SurfaceMap, GroupsThatHoldObjectsAreLookedInto) {
  const SurfaceMap map = map_surfaces(*make_street(), {{"wall", {"street/wall_left"}}});
  EXPECT_EQ(map.names, (Names{"wall", "street/wall_right", "street/floor", "pedestrian"}));
}

TEST(SurfaceMap, EachMirrorOfAGroupIsASurface) {
  Scene scene;
  add_group(scene, "street");
  add_square(scene, "left", {5, 0, 0}, 1, Material::metal(true), 0);
  add_square(scene, "right", {6, 0, 0}, 1, Material::metal(true), 0);
  add_group(scene, "house");
  add_square(scene, "front", {7, 0, 0}, 1, Material::metal(true), 3);
  add_square(scene, "roof", {8, 0, 0}, 1, Material::metal(), 3);
  EXPECT_EQ(map_surfaces(scene, {}).names, (Names{"street/left", "street/right", "house"}));
}

TEST(SurfaceMap, ObjectsAreChildrenOfTheRootAwayFromTheAntennaAndNoMirrors) {
  Scene scene;
  add_square(scene, "plate", {5, 0, 0}, 1, Material::metal());
  add_square(scene, "mirror", {6, 0, 0}, 1, Material::metal(true));
  add_square(scene, "around", {1, 0, 0}, 3, Material::metal());  // sphere of radius 4.2 m
  add_group(scene, "car");
  add_square(scene, "door", {0, 8, 0}, 1, Material::metal(), 3);
  add_square(scene, "window", {0, 9, 0}, 1, Material::metal(true), 3);
  const SurfaceMap map = map_surfaces(scene, 0.0, Vec3::Zero());
  EXPECT_EQ(map.names, (Names{"plate", "car", "mirror", "around", "car/window"}));
  EXPECT_EQ(map.num_objects, 2u);
  const SurfaceMap from_afar = map_surfaces(scene, 0.0, Vec3(-3.3, 0, 0));  // outside of that sphere by 0.06 m
  EXPECT_EQ(from_afar.num_objects, 3u);
}

// A box from `low` to `high`, of six faces.
void add_box(Scene& scene, const std::string& name, const Vec3& low, const Vec3& high) {
  add_mesh(scene, name, box_corners(low, high), kBoxTriangles, share(Material::metal()));
}

TEST(SurfaceMap, LongObjectsBesideTheAntennaStayObjects) {
  Scene scene;
  add_box(scene, "truck", {-9, 3, -1}, {8, 5.5, 3});          // in the next lane: its sphere of 8.8 m holds the antenna
  add_box(scene, "rail", {-50, -5.2, -0.7}, {50, -5, 0});     // a guard rail
  add_box(scene, "own", {-4.3, -0.9, -0.6}, {-0.1, 0.9, 1});  // 0.1 m behind the antenna
  add_box(scene, "tunnel", {-40, -6, -1}, {60, 6, 5});
  add_box(scene, "wall", {-20, 8, -1}, {20, 8.2, 4});
  add_box(scene, "road", {-50, -7, -1.2}, {50, 7, -1});
  const SurfaceMap map = map_surfaces(scene, 0.0, Vec3::Zero());
  EXPECT_EQ(map.names, (Names{"truck", "rail", "own", "tunnel", "wall", "road"}));
  EXPECT_EQ(map.num_objects, 2u);
}

TEST(SurfaceMap, WhatStandsCloseBeforeTheAntennaIsAnObject) {
  Scene scene;
  add_box(scene, "person", {0.4, -0.25, -1.1}, {0.7, 0.25, 0.6});  // its sphere of 0.9 m holds the antenna
  add_box(scene, "pole", {-0.3, -0.1, -1.5}, {-0.1, 0.1, 0.4});    // carries it
  add_box(scene, "tunnel", {0, -6, -1}, {60, 6, 5});               // begins at the antenna
  const SurfaceMap map = map_surfaces(scene, 0.0, Vec3::Zero(), Vec3::UnitX());
  EXPECT_EQ(map.names, (Names{"person", "pole", "tunnel"}));
  EXPECT_EQ(map.num_objects, 1u);
  const SurfaceMap turned = map_surfaces(scene, 0.0, Vec3::Zero(), -Vec3::UnitX());  // the pole is ahead now
  EXPECT_EQ(turned.names.front(), "pole");
  EXPECT_EQ(turned.num_objects, 1u);
  EXPECT_EQ(map_surfaces(scene, 0.0, Vec3::Zero()).num_objects, 0u);
}

TEST(SurfaceMap, ARecordTellsObjectsAtTheTimeThatItsFrameNames) {
  auto scene = std::make_shared<Scene>();
  add_box(*scene, "wall", {6, 4, -1}, {16, 4.2, 2});  // its sphere of 5.2 m holds the antenna from x = 7.6 to 14.3 m
  Paths paths;
  paths.scene = scene;
  paths.radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  paths.radar.motion = std::make_shared<LinearMotion>(Vec3(10, 0, 0));
  paths.frame.trace_time = 1.0;
  EXPECT_EQ(map_surfaces(paths).num_objects, 0u);
  paths.frame.objects_time = 0.0;
  EXPECT_EQ(map_surfaces(paths).num_objects, 1u);
}

TEST(SurfaceMap, BadObjectsAreErrors) {
  EXPECT_NE(error_of({{"", {"street"}}}).find("objects: must have non-empty names"), std::string::npos);
  EXPECT_NE(error_of({{"a", {"street"}}, {"a", {"pedestrian"}}}).find("a twice"), std::string::npos);
  EXPECT_NE(error_of({{"a", {"pedestrain"}}}).find("nearest names: pedestrian"), std::string::npos);
  EXPECT_NE(error_of({{"a", {"*"}}, {"b", {"street"}}}).find("none before it takes"), std::string::npos);
  EXPECT_NE(error_of({{"a", {}}}).find("none before it takes"), std::string::npos);
}

}  // namespace
}  // namespace echopath::test_surfaces
