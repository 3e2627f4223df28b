#include <gtest/gtest.h>

#include "cpp/support/boxes.h"
#include "echopath/posed/enclosures.h"

namespace echopath::test_enclosures {
namespace {

// A box about the origin with sides of 2 m, its first `count` triangles; outward or inward.
MeshPtr box(size_t count = 12, bool is_inward = false) {
  std::vector<Triangle> triangles = testing::kBoxTriangles;
  triangles.resize(count);
  if (is_inward) {
    for (Triangle& triangle : triangles) std::swap(triangle[0], triangle[1]);
  }
  return std::make_shared<const Mesh>(testing::box_corners(-Vec3::Ones(), Vec3::Ones()), triangles);
}

MaterialPtr metal() { return std::make_shared<const Material>(Material::metal()); }

MaterialPtr glass() {
  Material pane;
  pane.layers = {{4e-3, {6.3, -0.2}}};
  return std::make_shared<const Material>(pane);
}

int add(Scene& scene, const std::string& name, MeshPtr mesh, const Vec3& position, int parent = -1,
        MaterialPtr material = metal(), std::shared_ptr<const Motion> motion = nullptr) {
  Node node;
  node.name = name;
  node.parent = parent;
  node.mesh = std::move(mesh);
  if (node.mesh) node.material = std::move(material);
  node.placement = Transform(Eigen::Translation3d(position));
  node.motion = std::move(motion);
  return scene.add(node);
}

Radar radar_at(const Vec3& transmitter, const Vec3& receiver) {
  Radar radar;
  radar.transmitters.resize(1), radar.receivers.resize(1);
  radar.transmitters[0].position = transmitter, radar.receivers[0].position = receiver;
  return radar;
}

std::vector<Enclosure> enclosures_at(const Scene& scene, const Radar& radar, double time) {
  const PosedScene pose(scene, time);
  return enclosures(scene, pose, bodies_of(scene, pose), radar);
}

const Radar kInside = radar_at({0.3, -0.6, 0.9}, {3, 0, 0});

// A scene whose first object is `mesh`, with a box beside it.
Scene beside(MeshPtr mesh) {
  Scene scene;
  add(scene, "body", std::move(mesh), Vec3::Zero());
  add(scene, "other", box(), Vec3(10, 0, 0));
  return scene;
}

TEST(Enclosures, AClosedBodyHoldsWhatIsInsideHoweverItIsWound) {
  for (const bool is_inward : {false, true}) {
    const Scene scene = beside(box(12, is_inward));
    const auto found = enclosures_at(scene, kInside, 0.0);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].node, 0);
    EXPECT_FALSE(found[0].of_receivers);
    const auto swapped = enclosures_at(scene, radar_at({3, 0, 0}, {0.3, -0.6, 0.9}), 0.0);
    ASSERT_EQ(swapped.size(), 1u);
    EXPECT_TRUE(swapped[0].of_receivers);
  }
}

TEST(Enclosures, NoneWhereTheBodyIsOpenOrTheAntennaOutside) {
  EXPECT_TRUE(enclosures_at(beside(box(11)), kInside, 0.0).empty());
  EXPECT_TRUE(enclosures_at(beside(box()), radar_at({1.01, 0, 0}, {0, -1.01, 0}), 0.0).empty());
  EXPECT_TRUE(enclosures_at(Scene(), kInside, 0.0).empty());
}

TEST(Enclosures, NoneWhereNothingIsOutside) {
  Scene room;
  add(room, "room", box(), Vec3::Zero());
  EXPECT_TRUE(enclosures_at(room, kInside, 0.0).empty());
  add(room, "other", box(), Vec3(1.5, 0, 0));
  EXPECT_EQ(enclosures_at(room, kInside, 0.0).size(), 1u) << "a box that reaches out of the room";
}

// A cupboard that came with its room, as one object: wound as the walls or against them, the solid angles of both
// are 8 pi or 0.
TEST(Enclosures, AMeshOfABodyOfManyHoldsWhatIsInside) {
  for (const bool is_inward : {false, true}) {
    Scene scene;
    const int room = add(scene, "room", nullptr, Vec3::Zero());
    const int cupboard = add(scene, "cupboard", box(12, is_inward), Vec3::Zero(), room);
    add(scene, "table", box(), Vec3(0, 4, 0), room);
    std::vector<Vec3> corners = box()->vertices();
    for (Vec3& corner : corners) corner *= 10;
    add(scene, "walls", std::make_shared<const Mesh>(corners, box()->triangles()), Vec3::Zero(), room);
    for (const bool has_person : {false, true}) {
      if (has_person) add(scene, "person", box(), Vec3(5, 0, 0));
      const auto found = enclosures_at(scene, kInside, 0.0);
      ASSERT_EQ(found.size(), 1u) << (has_person ? "person and table" : "the table of the room alone") << " beside it";
      EXPECT_EQ(found[0].node, cupboard);
    }
    EXPECT_TRUE(enclosures_at(scene, radar_at({3, 0, 0}, {3, 1, 0}), 0.0).empty()) << "between the walls alone";
  }
}

TEST(Enclosures, AMeshThroughTheWallOfItsRoomIsNotOutside) {
  Scene scene;
  const int room = add(scene, "room", nullptr, Vec3::Zero());
  add(scene, "walls", box(), Vec3::Zero(), room);
  add(scene, "frame", box(), Vec3(1.5, 0, 0), room);
  EXPECT_TRUE(enclosures_at(scene, radar_at({-0.5, 0, 0}, {-0.5, 0, 0.1}), 0.0).empty());
  add(scene, "pole", box(), Vec3(1.5, 0, 0));
  EXPECT_TRUE(enclosures_at(scene, radar_at({-0.5, 0, 0}, {-0.5, 0, 0.1}), 0.0).empty()) << "nor is another body";
}

// Two open halves that close each other, below one parent; a pane in place of one of them lets waves out.
TEST(Enclosures, PartsCloseABodyTogetherAndSheetsOpenIt) {
  const auto half = [](bool is_rear) {
    const MeshPtr whole = box();
    const auto& all = whole->triangles();
    std::vector<Triangle> triangles(all.begin() + (is_rear ? 10 : 0), is_rear ? all.end() : all.begin() + 10);
    return std::make_shared<const Mesh>(whole->vertices(), triangles);
  };
  for (const bool is_pane : {false, true}) {
    Scene scene;
    const int body = add(scene, "body", nullptr, Vec3::Zero());
    add(scene, "front", half(false), Vec3::Zero(), body);
    add(scene, "rear", half(true), Vec3::Zero(), body, is_pane ? glass() : metal());
    add(scene, "other", box(), Vec3(10, 0, 0));
    EXPECT_EQ(enclosures_at(scene, kInside, 0.0).size(), is_pane ? 0u : 1u);
  }
}

TEST(Enclosures, TheTimeTells) {
  Scene scene;
  add(scene, "body", box(), Vec3::Zero(), -1, metal(), std::make_shared<const LinearMotion>(Vec3(0, 4, 0)));
  add(scene, "other", box(), Vec3(10, 0, 0));
  EXPECT_EQ(enclosures_at(scene, kInside, 0.0).size(), 1u);
  EXPECT_TRUE(enclosures_at(scene, kInside, 1.0).empty());
}

}  // namespace
}  // namespace echopath::test_enclosures
