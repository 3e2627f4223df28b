// Edges of meshes that touch.
#include <gtest/gtest.h>

#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/motion/motion.h"
#include "echopath/scene/scene_edges.h"

namespace echopath::test_scene_edges {
namespace {

MeshPtr quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return std::make_shared<const Mesh>(std::vector<Vec3>{a, b, c, d}, std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
}

class SceneEdgesTest : public ::testing::Test {
 protected:
  int add(const std::string& name, MeshPtr mesh, int parent = -1, const Transform& placement = Transform::Identity()) {
    Node node;
    node.name = name;
    node.mesh = std::move(mesh);
    node.material = std::make_shared<const Material>(metal_);
    node.parent = parent;
    node.placement = placement;
    return scene_.add(std::move(node));
  }
  int add_group(const std::string& name, std::shared_ptr<const Motion> motion) {
    Node node;
    node.name = name;
    node.motion = std::move(motion);
    return scene_.add(std::move(node));
  }
  double length(const SceneEdges& edges, uint32_t id, bool rims) const {
    double total = 0.0;
    const Mesh& mesh = *scene_.node_of(id).mesh;
    for (const SharpEdge& edge : edges.of(id)) {
      const Triangle& corners = mesh.triangles()[edge.triangle];
      const bool is_rim = (edge.inward[0] - edge.inward[1]).norm() < 1e-9;
      if (is_rim != rims) continue;
      total += (edge.end - edge.begin) *
               (mesh.vertices()[corners[(edge.side + 1) % 3]] - mesh.vertices()[corners[edge.side]]).norm();
    }
    return total;
  }

  Scene scene_;
  Material metal_ = [] {
    Material metal;
    metal.conductor = true;
    return metal;
  }();
};

// An L of two squares: they share one edge of 270 degrees.
TEST_F(SceneEdgesTest, AnEdgeBetweenTwoMeshesIsAWedgeOfTheFirst) {
  add("floor", quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}));
  add("wall", quad({0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}));
  const SceneEdges edges(scene_);
  EXPECT_NEAR(length(edges, 0, true), 3.0, 1e-9);
  EXPECT_NEAR(length(edges, 0, false), 1.0, 1e-9);
  EXPECT_NEAR(length(edges, 1, true), 3.0, 1e-9);
  EXPECT_EQ(length(edges, 1, false), 0.0);
  EXPECT_EQ(edges.body_of(1), 0u);
  for (const SharpEdge& edge : edges.of(0)) {
    if ((edge.inward[0] - edge.inward[1]).norm() < 1e-9) continue;
    const double angle = std::atan2(edge.inward[1].dot(edge.normal[0]), edge.inward[1].dot(edge.inward[0]));
    EXPECT_NEAR(angle < 0 ? angle + kTwoPi : angle, 1.5 * kPi, 1e-9);
  }
}

TEST_F(SceneEdgesTest, SheetsThatGoOnHaveNoRimsBetweenThem) {
  add("left", quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}));
  add("right", quad({0, 0, 0}, {1, 0, 0}, {1, 0.5, 0}, {0, 0.5, 0}), -1, Transform(Eigen::Translation3d(1.0, 0.25, 0.0)));
  const SceneEdges edges(scene_);
  EXPECT_NEAR(length(edges, 0, true), 3.5, 1e-9);
  EXPECT_NEAR(length(edges, 1, true), 2.5, 1e-9);
  EXPECT_EQ(length(edges, 0, false) + length(edges, 1, false), 0.0);
}

// Placements turn, mirror and scale; edges stand in the frames of their meshes.
TEST_F(SceneEdgesTest, PlacementsArePartOfTheGeometry) {
  add("floor", quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}));
  Transform place = Transform::Identity();
  place.linear() << 0, 0, 2, 0, 0.5, 0, -3, 0, 0;
  add("wall", quad({0, 0, 0}, {0, 2, 0}, {-1, 2, 0}, {-1, 0, 0}), -1, place);  // x to -3z, y to y/2: 1 high 3
  const SceneEdges edges(scene_);
  EXPECT_NEAR(length(edges, 0, false), 1.0, 1e-9);
  EXPECT_NEAR(length(edges, 1, true), 4.0, 1e-9);  // in its own measures
}

TEST_F(SceneEdgesTest, OnlyMeshesThatStayTogetherAreOneSurface) {
  const auto moving = std::make_shared<const LinearMotion>(Vec3(1, 0, 0));
  const int car = add_group("car", moving);
  add("door", quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}), car);
  add("roof", quad({0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}), car);
  add("pillar", quad({0, 0, 0}, {0, 1, 0}, {0, 1, -1}, {0, 0, -1}));
  const SceneEdges edges(scene_);
  EXPECT_NEAR(length(edges, 0, false), 1.0, 1e-9);
  EXPECT_NEAR(length(edges, 2, true), 4.0, 1e-9);
  EXPECT_EQ(edges.body_of(2), 2u);
}

TEST_F(SceneEdgesTest, MeshesWhoseMotionsRestStayTogether) {
  const auto lowered = std::make_shared<const KeyframeMotion>(std::vector{3.0, 4.0}, std::vector(2, Vec3(0, 0, -2)),
                                                              std::vector<Quaternion>());
  add("floor", quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}),
      add_group("slab", std::make_shared<LinearMotion>(Vec3::Zero())));
  add("wall", quad({0, 0, 2}, {0, 1, 2}, {0, 1, 3}, {0, 0, 3}), add_group("panel", lowered));
  const SceneEdges edges(scene_);
  EXPECT_NEAR(length(edges, 0, false), 1.0, 1e-9);
  EXPECT_EQ(edges.body_of(1), 0u);
}

// As they stay together, whoever moves them: a floor and a wall, which share an edge of 1 m.
TEST_F(SceneEdgesTest, MeshesThatMoveAlikeStayTogether) {
  const auto placed = [](const Vec3& at) { return Transform(Eigen::Translation3d(at)); };
  const auto floor = quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}),
             wall = quad({0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1});
  const auto moving = [](const Vec3& velocity, const Vec3& turning) {
    return std::make_shared<const LinearMotion>(velocity, turning);
  };
  const auto keyed = std::make_shared<const KeyframeMotion>(std::vector{0.0, 1.0}, std::vector<Vec3>{{0, 0, 0}, {1, 2, 0}},
                                                            std::vector<Quaternion>());
  struct Case {
    std::shared_ptr<const Motion> of_floor, of_wall;
    Vec3 wall_at;
    bool are_together;
  };
  const Vec3 along(3, 0, 0), up(0, 0, 1), none = Vec3::Zero();
  for (const Case& one : {Case{moving(along, none), moving(along, none), {1, 0, 0}, true},
                          Case{moving(along, none), moving(1.1 * along, none), {1, 0, 0}, false},
                          Case{moving(along, up), moving(along, up), {0, 0, 0}, true},
                          Case{moving(along, up), moving(along, up), {1, 0, 0}, false},  // each turns about its own origin
                          Case{keyed, keyed, {0, 0, 0}, true}, Case{keyed, nullptr, {0, 0, 0}, false}}) {
    scene_ = Scene();
    for (const bool is_wall : {false, true}) {
      Node node;
      node.name = is_wall ? "wall" : "floor";
      node.motion = is_wall ? one.of_wall : one.of_floor;
      node.placement = placed(is_wall ? one.wall_at : none);
      const int mover = scene_.add(std::move(node));
      add(is_wall ? "panel" : "plate", is_wall ? wall : floor, mover);
    }
    EXPECT_NEAR(length(SceneEdges(scene_), 0, false), one.are_together ? 1.0 : 0.0, 1e-9);
  }
}

TEST_F(SceneEdgesTest, OtherMaterialsTakeNoPart) {
  add("floor", quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}));
  metal_.mirror = true;
  add("wall", quad({0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}));
  const SceneEdges edges(scene_);
  EXPECT_NEAR(length(edges, 0, true), 4.0, 1e-9);
  EXPECT_TRUE(edges.of(1).empty());
}

// Parts of one whole have its edges, wherever another mesh touches them.
TEST_F(SceneEdgesTest, PartsOfAWholeMeetOthers) {
  const auto whole = std::make_shared<const Mesh>(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                                  std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
  add("lower", Mesh::part(whole, {0}));
  add("upper", Mesh::part(whole, {1}));
  add("wall", quad({0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}));
  const SceneEdges edges(scene_);
  EXPECT_NEAR(length(edges, 0, true), 2.0, 1e-9);
  EXPECT_NEAR(length(edges, 1, true), 1.0, 1e-9);
  EXPECT_NEAR(length(edges, 1, false), 1.0, 1e-9);
  EXPECT_NEAR(length(edges, 2, true), 3.0, 1e-9);
}

}  // namespace
}  // namespace echopath::test_scene_edges
