#include <gtest/gtest.h>

#include <cmath>

#include "cpp/scene/small_nodes.h"
#include "echopath/base/constants.h"
#include "echopath/posed/posed_scene.h"

namespace echopath::test_posed_scene {
namespace {

using testing::triangle;

constexpr double kRounding = 1e-13;  // of products of a few transforms with entries of order 10

MaterialPtr metal() { return std::make_shared<const Material>(Material::metal()); }

// 4x4 matrices written out, to share nothing with the transforms of the program.
using Matrix4 = Eigen::Matrix4d;

Matrix4 shift(double x, double y, double z) {
  Matrix4 m = Matrix4::Identity();
  m.col(3) << x, y, z, 1;
  return m;
}

Matrix4 turn_z(double angle) {
  Matrix4 m = Matrix4::Identity();
  m.row(0) << std::cos(angle), -std::sin(angle), 0, 0;
  m.row(1) << std::sin(angle), std::cos(angle), 0, 0;
  return m;
}

Matrix4 turn_x(double angle) {
  Matrix4 m = Matrix4::Identity();
  m.row(1) << 0, std::cos(angle), -std::sin(angle), 0;
  m.row(2) << 0, std::sin(angle), std::cos(angle), 0;
  return m;
}

Transform transform(const Matrix4& matrix) {
  Transform result;
  result.matrix() = matrix;
  return result;
}

Node node(const std::string& name, int parent, const Matrix4& placement, std::shared_ptr<const Motion> motion = nullptr) {
  Node made;
  made.name = name;
  made.parent = parent;
  made.placement = transform(placement);
  made.motion = std::move(motion);
  return made;
}

// A car that drives and turns, on it a turret that rotates, on that a radar dish at rest, tilted.
Scene driving_scene() {
  Scene scene;
  scene.add(
      node("car", -1, shift(10, 2, 0) * turn_z(0.5), std::make_shared<const LinearMotion>(Vec3(3, 1, 0), Vec3(0, 0, 0.2))));
  scene.add(
      node("turret", 0, shift(0, 0, 1.5) * turn_x(0.1), std::make_shared<const LinearMotion>(Vec3::Zero(), Vec3(0, 0, 2))));
  Node dish = node("dish", 1, shift(0.4, 0, 0.2) * turn_x(-0.7));
  dish.mesh = triangle(), dish.material = metal();
  scene.add(dish);
  return scene;
}

TEST(PosedScene, NestedMotionsAreTheProductOfTheirMatrices) {
  const Scene scene = driving_scene();
  for (const double t : {-1.0, 0.0, 0.3, 2.0}) {
    const Matrix4 car = shift(10, 2, 0) * shift(3 * t, t, 0) * turn_z(0.2 * t) * turn_z(0.5);
    const Matrix4 turret = shift(0, 0, 1.5) * turn_z(2 * t) * turn_x(0.1);
    const Matrix4 dish = shift(0.4, 0, 0.2) * turn_x(-0.7);
    const PosedScene pose(scene, t);
    EXPECT_EQ(pose.time(), t);
    const Matrix4 expected = car * turret * dish;
    EXPECT_LT((pose.linear(0) - expected.topLeftCorner<3, 3>()).norm(), kRounding);
    EXPECT_LT((pose.world_translation(0) - expected.topRightCorner<3, 1>()).norm(), kRounding);
  }
}

TEST(PosedScene, AMotionTurnsANodeAboutItsOwnOriginInTheAxesOfItsParent) {
  Scene scene;
  Node fan = node("fan", -1, shift(5, 0, 0) * turn_x(kPi / 2),
                  std::make_shared<const LinearMotion>(Vec3::Zero(), Vec3(0, 0, kPi / 2)));
  fan.mesh = triangle(), fan.material = metal();
  scene.add(fan);
  const std::vector<Vec3> vertices = PosedScene(scene, 1.0).world_vertices(0);
  EXPECT_LT((vertices[0] - Vec3(5, 0, 0)).norm(), kRounding);
  EXPECT_LT((vertices[1] - Vec3(5, 1, 0)).norm(), kRounding);  // x axis of the fan, a quarter turn about the parent's z
  EXPECT_LT((vertices[2] - Vec3(5, 0, 1)).norm(), kRounding);  // y axis, tilted up by the placement
}

TEST(PosedScene, TheCentroidOfASurfaceWeighsTrianglesByTheirAreas) {
  Scene scene;
  Node small = node("small", -1, shift(5, 0, 0));
  small.mesh = triangle(), small.material = metal();
  Matrix4 placement = shift(0, 3, 0);
  placement.topLeftCorner<3, 3>() *= 2.0;  // of four times the area
  Node large = node("large", -1, placement, std::make_shared<const LinearMotion>(Vec3(0, 0, 1), Vec3::Zero()));
  large.mesh = triangle(), large.material = metal();
  scene.add(small);
  scene.add(large);
  const Vec3 third = Vec3(1, 1, 0) / 3.0;  // middle of the triangle in its own axes
  const Vec3 expected = 0.2 * (Vec3(5, 0, 0) + third) + 0.8 * (Vec3(0, 3, 7) + 2.0 * third);
  EXPECT_LT((surface_centroid(scene, std::array<uint32_t, 2>{0, 1}, 7.0) - expected).norm(), kRounding);
}

// The last bits of vertices are 1e-9 m there; moments about the origin of the world would round by more.
TEST(PosedScene, TheCentroidOfASurfaceFarFromTheOriginIsAsExactAsItsVertices) {
  const Vec3 far(691607, 5334760, 520);
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  constexpr uint32_t kSides = 10000;  // of a cylinder about the z axis
  for (uint32_t k = 0; k < kSides; ++k) {
    const double turn = kTwoPi * k / kSides;
    for (const double height : {0.0, 1.0}) vertices.emplace_back(std::cos(turn), std::sin(turn), height);
    const uint32_t next = (k + 1) % kSides;
    triangles.push_back({2 * k, 2 * next, 2 * k + 1});
    triangles.push_back({2 * next, 2 * next + 1, 2 * k + 1});
  }
  Scene scene;
  Node tube = node("tube", -1, shift(far.x(), far.y(), far.z()));
  tube.mesh = std::make_shared<const Mesh>(vertices, triangles), tube.material = metal();
  scene.add(tube);
  const Vec3 centroid = surface_centroid(scene, std::array<uint32_t, 1>{0}, 0.0);
  EXPECT_LT((centroid - far - Vec3(0, 0, 0.5)).norm(), 3e-9);
}

TEST(PosedScene, TrianglesVerticesAndSingleMeshesAgree) {
  const Scene scene = driving_scene();
  const PosedScene pose(scene, 0.7);
  const std::vector<Vec3> all = pose.world_vertices(0);
  const std::array<Vec3, 3> corners = pose.world_triangle(0, 0);
  const std::vector<Vec3> alone = world_vertices(scene, 0, 0.7);
  for (size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(corners[k], all[k]);
    EXPECT_LT((alone[k] - all[k]).norm(), kRounding);
    EXPECT_LT((pose.linear(0) * pose.local_vertices(0)[k] + pose.translation(0) - all[k]).norm(), kRounding);
  }
}

// A triangle whose second corner rises by 1 m/s, up to 2 s.
Scene scene_of_flag(const Matrix4& placement, std::shared_ptr<const Motion> motion = nullptr) {
  Scene scene;
  Node flag = node("flag", -1, placement, std::move(motion));
  flag.mesh = triangle(), flag.material = metal();
  std::vector<Vec3> raised = triangle()->vertices();
  raised[1].z() = 2.0;
  flag.deformation = std::make_shared<const VertexSequence>(std::vector<double>{0, 2},
                                                            std::vector<std::vector<Vec3>>{triangle()->vertices(), raised});
  scene.add(flag);
  return scene;
}

TEST(PosedScene, ASequenceDeformsInTheFrameOfItsNode) {
  const Scene scene = scene_of_flag(shift(0, 0, 4) * turn_z(kPi / 2), std::make_shared<const LinearMotion>(Vec3(1, 0, 0)));
  const Vec3 expected = (shift(1, 0, 0) * shift(0, 0, 4) * turn_z(kPi / 2) * Eigen::Vector4d(1, 0, 1, 1)).head<3>();
  EXPECT_LT((PosedScene(scene, 1.0).world_vertices(0)[1] - expected).norm(), kRounding);
  EXPECT_LT((world_vertices(scene, 0, 1.0)[1] - expected).norm(), kRounding);
  EXPECT_THROW(PosedScene(scene, 2.5), std::invalid_argument);
}

// The one mesh of a scene.
MeshesToPose one_mesh(const Scene& scene, std::vector<SurfacePatch> patches) {
  auto places = std::make_shared<MeshPlaces>(1);
  places->add(0);
  return {scene, std::move(places), std::move(patches)};
}

// Patches hold the vertices that they name, in their order, and nothing of them may be taken for the whole mesh.
TEST(PosedScene, DeformingMeshesArePosedInPatches) {
  const Scene scene = scene_of_flag(Matrix4::Identity());
  Radar radar;
  radar.transmitters = radar.receivers = {Antenna()};
  SurfacePatch patch;
  patch.original_vertex = {2, 1};
  const PosedScene posed(scene, radar, one_mesh(scene, {patch}), Vec3::Zero(), 1.0);
  ASSERT_EQ(posed.local_vertices(0).size(), 2u);
  EXPECT_LT((posed.local_vertices(0)[0] - triangle()->vertices()[2]).norm(), kRounding);
  EXPECT_NEAR(posed.local_vertices(0)[1].z(), 1.0, kRounding);
  EXPECT_THROW(posed.world_vertices(0), std::invalid_argument);
  EXPECT_THROW(posed.world_triangle(0, 0), std::invalid_argument);
  EXPECT_THROW(one_mesh(scene, {}), std::invalid_argument);
}

// A mirrored placement turns the winding, and normals with it; uneven scales tilt them as cofactors do.
TEST(PosedScene, NormalsFollowTheWindingThroughReflectionsAndScales) {
  Scene scene;
  Matrix4 placement = Matrix4::Identity();
  placement.diagonal() = Eigen::Vector4d(2.0, -1.0, 3.0, 1.0);
  Node plate = node("plate", -1, placement, nullptr);
  plate.mesh = triangle(), plate.material = metal();
  scene.add(plate);
  const PosedScene posed(scene, 0.0);
  const auto [a, b, c] = posed.world_triangle(0, 0);
  const std::vector<Vec3> local = triangle()->vertices();
  const Vec3 normal = (local[1] - local[0]).cross(local[2] - local[0]).normalized();
  const Vec3 wanted = (b - a).cross(c - a).normalized();
  EXPECT_LT(((posed.normal_matrix(0) * normal).normalized() - wanted).norm(), kRounding);
  for (const Vec3& of_vertex : posed.world_normals(0)) EXPECT_LT((of_vertex - wanted).norm(), kRounding);
}

TEST(PosedScene, NormalsOfWhatDeformsAreThoseOfItsShapeAtTheTime) {
  const Scene scene = scene_of_flag(shift(1, 2, 3) * turn_z(0.7));
  const Vec3 wanted = (turn_z(0.7) * Eigen::Vector4d(-1.0, 0.0, 1.0, 0.0)).head<3>() / std::sqrt(2.0);  // z rises as x does
  const std::vector<Vec3> normals = PosedScene(scene, 1.0).world_normals(0);
  ASSERT_EQ(normals.size(), 3u);
  for (const Vec3& normal : normals) EXPECT_LT((normal - wanted).norm(), kRounding);
}

// Of a scene with other things.
TEST(PosedScene, AFewMeshesArePlacedAsTheProductOfTheirMatrices) {
  Scene scene;
  scene.add(testing::with_mesh("tree"));
  scene.add(node("car", -1, shift(10, 2, 0) * turn_z(0.5), std::make_shared<const LinearMotion>(Vec3(3, 1, 0))));
  scene.add(testing::with_mesh("lamp", 0));
  Node dish = testing::with_mesh("dish", 1);
  dish.placement = transform(shift(0.4, 0, 0.2) * turn_x(-0.7));
  scene.add(dish);
  const Matrix4 car = shift(10 + 3 * 0.3, 2 + 0.3, 0) * turn_z(0.5), wanted = car * shift(0.4, 0, 0.2) * turn_x(-0.7);
  const std::vector<uint32_t> meshes = {2};
  const std::vector<Transform> placed = PlacingNodes(scene, meshes).world_from_meshes(0.3);
  ASSERT_EQ(placed.size(), 1u);
  EXPECT_LT((placed[0].matrix() - wanted).norm(), kRounding);
}

// A radar that turns by 0.5 rad/s about z while it goes on: its antennas, too, stand relative to the origin.
TEST(PosedScene, AntennasMoveAndTurnWithTheRadar) {
  Radar radar;
  Antenna antenna;
  antenna.position = Vec3(0, 0.2, 0);
  antenna.orientation = Quaternion(Eigen::AngleAxisd(0.3, Vec3::UnitZ()));
  antenna.pattern = AntennaPattern::cosine_power(2.0);
  radar.transmitters = {antenna};
  radar.receivers = {Antenna(), antenna};
  radar.motion = std::make_shared<const LinearMotion>(Vec3(4, 0, 0), Vec3(0, 0, 0.5));
  const Scene scene = driving_scene();
  const Vec3 origin(1, 2, 3);
  const PosedScene posed(scene, radar, one_mesh(scene, {SurfacePatch()}), origin, 2.0);
  ASSERT_EQ(posed.antennas(false).size(), 1u);
  ASSERT_EQ(posed.antennas(true).size(), 2u);
  const PosedAntenna& first = posed.transmitters.front();
  EXPECT_LT((first.position - (Vec3(8, 0, 0) + 0.2 * Vec3(-std::sin(1.0), std::cos(1.0), 0) - origin)).norm(), kRounding);
  EXPECT_LT((first.boresight - Vec3(std::cos(1.3), std::sin(1.3), 0)).norm(), kRounding);
  EXPECT_LT((first.polarization - Vec3::UnitZ()).norm(), kRounding);
  const Vec3 aside(std::cos(1.3 + kPi / 3), std::sin(1.3 + kPi / 3), 0);
  EXPECT_NEAR(first.toward(aside).power / first.toward(first.boresight).power, 0.25, kRounding);
  const PosedScene in_world(scene, 2.0);
  EXPECT_LT((posed.translation(0) + origin - in_world.translation(0)).norm(), kRounding);
  EXPECT_TRUE(in_world.transmitters.empty());
}

// A radar at a place of its own, turned left by a quarter and up by 0.3 rad, that drives along the world's x.
TEST(PosedScene, AntennasStandWhereTheirRadarIsPlaced) {
  Radar radar;
  Antenna antenna;
  antenna.position = Vec3(0.1, 0.2, 0);
  radar.transmitters = radar.receivers = {antenna};
  radar.position = Vec3(7, -1, 2), radar.yaw = kPi / 2, radar.pitch = 0.3;
  radar.motion = std::make_shared<const LinearMotion>(Vec3(4, 0, 0));
  const Vec3 origin(1, 2, 3);
  const Scene scene = driving_scene();
  const PosedScene posed(scene, radar, one_mesh(scene, {SurfacePatch()}), origin, 2.0);
  const Vec3 ahead(0, std::cos(0.3), std::sin(0.3)), left(-1, 0, 0), up(0, -std::sin(0.3), std::cos(0.3));
  const PosedAntenna& first = posed.receivers.front();
  EXPECT_LT((first.position - (Vec3(15, -1, 2) + 0.1 * ahead + 0.2 * left - origin)).norm(), kRounding);
  EXPECT_LT((first.boresight - ahead).norm(), kRounding);
  EXPECT_LT((first.polarization - up).norm(), kRounding);
}

TEST(PosedScene, AnEmptySceneHasOne) { EXPECT_EQ(PosedScene(Scene(), 3.0).time(), 3.0); }

}  // namespace
}  // namespace echopath::test_posed_scene
