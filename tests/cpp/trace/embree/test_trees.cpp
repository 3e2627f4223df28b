// Trees that are kept and fitted answer as trees grown anew, after any sequence of changes; small neighbours share a tree,
// and what rays meet of it goes by its own name.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "answers.h"
#include "cpp/support/boxes.h"
#include "cpp/support/scenes.h"
#include "echopath/trace/embree/mesh_clusters.h"
#include "echopath/trace/embree/tree_shape.h"

namespace echopath::test_trees {
namespace {

using namespace testing;

constexpr int kRows = 20, kColumns = 20;  // of boxes

Node node_of(const std::string& name, const Surface& surface, const Vec3& position) {
  Node node = node_with(name, surface, lambert(0.5));
  node.placement = Transform(Eigen::Translation3d(position));
  return node;
}

// A box of 12 triangles about the origin.
Surface box(double length) {
  const Vec3 high = Vec3::Constant(0.5 * length);
  return {box_corners(-high, high), kBoxTriangles};
}

// A wall of boxes that face the origin, 1 m apart.
Scene wall_of_boxes() {
  Scene scene;
  Node node = node_of("box", box(0.8), Vec3::Zero());
  for (int i = 0; i < kRows * kColumns; ++i) {
    node.name = "box" + std::to_string(i);
    node.placement = Transform(Eigen::Translation3d(12.0, i % kColumns - 9.5, i / kColumns - 9.5));
    scene.add(node);
  }
  return scene;
}

// Swings to and fro in the mesh's frame.
std::shared_ptr<const Deformation> waves(const Surface& surface, double height) {
  std::vector<std::vector<Vec3>> frames(5, surface.vertices);
  for (size_t k = 0; k < frames.size(); ++k) {
    for (Vec3& vertex : frames[k]) vertex.x() += height * static_cast<double>(k) * std::sin(6.0 * vertex.y());
  }
  return std::make_shared<VertexSequence>(std::vector<double>{0.0, 1.0, 2.0, 3.0, 4.0}, frames);
}

// The wall of boxes, and before it bodies that drive, turn, bend little and much, a coincident copy of one, and one at rest.
Scene mixed_scene() {
  Scene scene = wall_of_boxes();
  const Surface body = ellipsoid(Vec3::Zero(), {0.8, 1.2, 0.5}, 3);
  const std::vector<std::pair<double, double>> bends = {{0.0, 0.0}, {0.0, 0.0}, {0.02, 0.0}, {0.3, 0.3}, {0.0, 0.0}};
  for (size_t i = 0; i < bends.size(); ++i) {
    Node node = node_of("body" + std::to_string(i), body, {8.0, -4.0 + 2.0 * static_cast<double>(i / 2 * 2), 0.2});
    if (bends[i].first > 0.0) node.deformation = waves(body, bends[i].first);
    if (i < 4)
      node.motion = std::make_shared<LinearMotion>(Vec3(0.2, 0.1, 0.0), Vec3(0.1, 0.3 * static_cast<double>(i / 2), 0.8));
    scene.add(node);
  }
  return scene;
}

// Moves, hides, shows, adds or removes something.
void change(Scene& scene, std::mt19937& random, int step) {
  const auto draw = [&](int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); };
  const int index = draw(static_cast<int>(scene.nodes().size()));
  Node node = scene.nodes()[static_cast<size_t>(index)];
  switch (draw(5)) {
    case 0: node.visible = !node.visible; return scene.change(index, node);
    case 1: return scene.remove(index);
    case 2:
      scene.add(node_of("new" + std::to_string(step), box(0.5 + 0.1 * draw(8)), {9.0, draw(10) - 5.0, draw(4) - 2.0}));
      return;
    default: {
      const Vec3 shift(0.3 * draw(3), 0.7 * draw(5) - 1.4, 0.2 * draw(5) - 0.4);
      node.placement = Eigen::Translation3d(shift) * node.placement * Eigen::AngleAxisd(0.4 * draw(5), Vec3::UnitZ());
      return scene.change(index, node);
    }
  }
}

void expect_as_fresh(EmbreeScene& kept, const Scene& scene, double time) {
  const PosedScene pose(scene, time);
  kept.update(scene, pose, Vec3::Zero());
  expect_same(answers_of(EmbreeScene(scene, pose, Vec3::Zero())), answers_of(kept));
}

TEST(Trees, AnswerAsFreshOnesAfterAnyChanges) {
  std::mt19937 random(3);
  Scene scene = mixed_scene();
  EmbreeScene kept;
  double time = 0.0;
  for (int step = 0; step < 40; ++step) {
    for (int k = 0; k < step % 4; ++k) change(scene, random, 10 * step + k);
    time = step % 3 == 0 ? std::fmod(time + 0.37, 3.9) : time;
    expect_as_fresh(kept, scene, time);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

TEST(Trees, AnswerAsFreshOnesWhereTheOriginMoves) {
  const Scene scene = mixed_scene();
  EmbreeScene kept;
  for (const double x : {0.0, 1.0, 1.0, -40.0}) {
    const PosedScene pose(scene, 0.5 + 0.1 * x * x / 1600.0);
    EmbreeScene fresh;
    kept.update(scene, pose, Vec3(x, 0, 0), EmbreeScene::Upkeep::kMovingRadar, nullptr);
    fresh.update(scene, pose, Vec3(x, 0, 0), EmbreeScene::Upkeep::kMovingRadar, nullptr);
    EXPECT_EQ(kept.origin(), fresh.origin());
    EXPECT_EQ(kept.origin(), EmbreeScene::origin_near(scene, pose, Vec3(x, 0, 0), true));
  }
}

// A box moves on beyond all others, and then beyond 128 m.
TEST(Trees, EditsSeldomChangeOriginLiftAndReach) {
  EmbreeScene kept;
  std::set<double> lifts, reaches, origins;
  for (const double x : {90.0, 101.0, 113.0, 120.0, 150.0}) {
    Scene scene = mixed_scene();
    scene.add(node_of("far", box(0.5), {x, 0.0, 0.0}));
    const PosedScene pose(scene, 0.0);
    EmbreeScene fresh;
    kept.update(scene, pose, Vec3(0.1, 0, 0), EmbreeScene::Upkeep::kEdits, nullptr);
    fresh.update(scene, pose, Vec3(0.1, 0, 0), EmbreeScene::Upkeep::kEdits, nullptr);
    expect_same(answers_of(fresh), answers_of(kept));
    EXPECT_GE(kept.lift(), EmbreeScene(scene, pose, kept.origin()).lift());
    EXPECT_LE(kept.lift(), 2.0 * EmbreeScene(scene, pose, kept.origin()).lift());
    lifts.insert(kept.lift());
    reaches.insert(kept.reach());
    origins.insert(kept.origin().x());
  }
  EXPECT_EQ(lifts.size(), 2u);
  EXPECT_EQ(reaches.size(), 2u);
  EXPECT_LE(origins.size(), 2u);
}

// The box in row r and column c is met where it stands, whatever tree it is in.
TEST(Trees, WhatIsMetOfASharedTreeGoesByItsOwnName) {
  const Scene scene = wall_of_boxes();
  const EmbreeScene geometry(scene, PosedScene(scene, 0.0), Vec3::Zero());
  for (uint32_t mesh = 0; mesh < kRows * kColumns; ++mesh) {
    const Vec3 face(11.6, mesh % kColumns - 9.4, mesh / kColumns - 9.45);
    RayHit hit;
    ASSERT_EQ(geometry.intersect(Vec3(0, face.y(), face.z()), Vec3::UnitX(), hit), EmbreeScene::Verdict::kHit);
    EXPECT_EQ(hit.hit.mesh_id, mesh);
    EXPECT_EQ(hit.hit.triangle_id / 2, 4u);  // the face at -x
    EXPECT_NEAR((hit.position - face).norm(), 0.0, 1e-6);
    EmbreeScene::MeshHits hits;
    LaneVectors along;
    for (int lane = 0; lane < kPacketSize; ++lane) along.set(lane, unpacked(Vec3(Vec3::UnitX())));
    EmbreeScene::Stretches stretches{};
    stretches.end[0] = 100.0;
    geometry.intersect_meshes(Vec3(0, face.y(), face.z()), along, stretches, ~0u, hits);
    EXPECT_EQ(hits.mesh_id[0], mesh);
  }
}

std::vector<SmallMesh> grid_of_meshes(uint32_t count) {
  std::vector<SmallMesh> meshes;
  for (uint32_t i = 0; i < count; ++i) {
    const Vec3 low(3.0 * (i % 64), 3.0 * (i / 64), 0.0);
    meshes.push_back({i, 12, {low, low + Vec3::Ones()}});
  }
  return meshes;
}

TEST(MeshClusters, HoldEachMeshOnceAndFewTriangles) {
  std::set<uint32_t> seen;
  for (const std::vector<uint32_t>& cluster : clusters_of(grid_of_meshes(4096))) {
    EXPECT_LE(12 * cluster.size(), 2000u);
    EXPECT_TRUE(std::is_sorted(cluster.begin(), cluster.end()));
    for (const uint32_t mesh : cluster) EXPECT_TRUE(seen.insert(mesh).second);
  }
  EXPECT_GT(seen.size(), 4000u);
  EXPECT_TRUE(clusters_of(grid_of_meshes(100)).empty());
}

TEST(MeshClusters, LeaveOutWhatIsAsLargeAsTheyAre) {
  std::vector<SmallMesh> meshes = grid_of_meshes(4096);
  meshes.push_back({4096, 2, {Vec3(-10, -10, -1), Vec3(210, 210, -1)}});
  for (const std::vector<uint32_t>& cluster : clusters_of(meshes)) EXPECT_LT(cluster.back(), 4096u);
}

TEST(MeshClusters, AMoveChangesThoseAboutItAlone) {
  std::vector<SmallMesh> meshes = grid_of_meshes(4096);
  const std::vector<std::vector<uint32_t>> before = clusters_of(meshes);
  meshes[1000].box.translate(Vec3(20.0, 15.0, 0.0));
  int num_other = 0;
  for (const std::vector<uint32_t>& cluster : clusters_of(meshes))
    num_other += std::count(before.begin(), before.end(), cluster) == 0;
  EXPECT_GE(num_other, 1);
  EXPECT_LE(num_other, 4);
}

Mat3 turn(double angle) { return Eigen::AngleAxisd(angle, Vec3(1, 2, 3).normalized()).toRotationMatrix(); }

TEST(TreeShape, IsTheNearestTurnOfTheMeshAtRest) {
  const Surface body = ellipsoid(Vec3(5, 0, 0), {0.8, 1.2, 0.5}, 2);
  const Mesh mesh(body.vertices, body.triangles);
  for (const double angle : {0.0, 0.3, 1.0, 3.0}) {
    std::vector<Vec3> vertices = body.vertices;
    for (Vec3& vertex : vertices) vertex = 2.0 * (turn(angle) * vertex) + Vec3(1, 2, 3);
    const TreeShape shape = shape_of_rigid(mesh, 2.0 * turn(angle), vertices);
    EXPECT_FALSE(shape.is_present);
    EXPECT_LE((shape.rotation() - turn(angle)).cwiseAbs().maxCoeff(), 0.5 * TreeShape::kTurnStep);
    EXPECT_EQ(shape, shape_of_deformed(mesh, vertices));
  }
}

TEST(TreeShape, IsThePresentOneWhereAMeshIsBent) {
  const Surface body = ellipsoid(Vec3::Zero(), {0.8, 1.2, 0.5}, 3);
  const Mesh mesh(body.vertices, body.triangles);
  const auto twisted = [&](double rate) {
    std::vector<Vec3> vertices = body.vertices;
    for (Vec3& vertex : vertices) vertex = Eigen::AngleAxisd(rate * vertex.y(), Vec3::UnitY()) * vertex;
    return shape_of_deformed(mesh, vertices).is_present;
  };
  EXPECT_FALSE(twisted(0.1));
  EXPECT_TRUE(twisted(1.5));
  std::vector<Vec3> stretched = body.vertices;
  for (Vec3& vertex : stretched) vertex.z() *= 20.0;
  EXPECT_TRUE(shape_of_rigid(mesh, Vec3(1, 1, 20).asDiagonal(), stretched).is_present);
  EXPECT_TRUE(shape_of_deformed(mesh, std::vector<Vec3>(body.vertices.size(), Vec3::Zero())).is_present);
}

}  // namespace
}  // namespace echopath::test_trees
