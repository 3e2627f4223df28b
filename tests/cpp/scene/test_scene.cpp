#include <gtest/gtest.h>

#include <limits>

#include "cpp/scene/small_nodes.h"
#include "cpp/support/expect_error.h"
#include "echopath/scene/scene.h"

namespace echopath::test_scene {
namespace {

using test::expect_error;
using namespace testing;
using Invalid = std::invalid_argument;

TEST(Glob, StarsCrossSlashesAndQuestionMarksAreOneCharacter) {
  EXPECT_TRUE(glob_takes("wall", "wall"));
  EXPECT_TRUE(glob_takes("*", "a/b"));
  EXPECT_TRUE(glob_takes("street/*wheel", "street/car/left/wheel"));
  EXPECT_TRUE(glob_takes("arm_?", "arm_l"));
  EXPECT_TRUE(glob_takes("b?ume", "bäume"));
  EXPECT_TRUE(glob_takes("*?", "ä"));
  EXPECT_FALSE(glob_takes("b??ume", "bäume"));
  EXPECT_FALSE(glob_takes("*??", "ä"));
  EXPECT_TRUE(glob_takes("a*b*c", "aXbYbZc"));
  EXPECT_FALSE(glob_takes("a*b*c", "aXbYbZ"));
  EXPECT_FALSE(glob_takes("arm_?", "arm_"));
  EXPECT_FALSE(glob_takes("wall", "wall_left"));
  EXPECT_FALSE(glob_takes("all", "wall"));
  EXPECT_FALSE(glob_takes("", "wall"));
  EXPECT_TRUE(glob_takes("w**l", "wall"));
  EXPECT_TRUE(glob_takes("wall*", "wall"));
}

TEST(Glob, TakesAMeshByItsAncestors) {
  EXPECT_TRUE(glob_takes("pedestrian", "pedestrian/arm/hand"));
  EXPECT_TRUE(glob_takes("ped*/arm", "pedestrian/arm/hand"));
  EXPECT_FALSE(glob_takes("arm", "pedestrian/arm/hand"));
  EXPECT_FALSE(glob_takes("ped", "pedestrian/arm"));
}

// Every glob of up to four characters against every name of up to four, by the definition.
bool by_definition(const std::string& glob, const std::string& name) {
  if (glob.empty()) return name.empty();
  if (glob[0] == '*') {
    return by_definition(glob.substr(1), name) || (!name.empty() && by_definition(glob, name.substr(1)));
  }
  return !name.empty() && (glob[0] == '?' || glob[0] == name[0]) && by_definition(glob.substr(1), name.substr(1));
}

std::vector<std::string> words(const std::string& letters) {
  std::vector<std::string> all = {""};
  for (size_t begin = 0, length = 0; length < 4; ++length) {
    const size_t end = all.size();
    for (; begin < end; ++begin) {
      for (const char letter : letters) all.push_back(all[begin] + letter);
    }
  }
  return all;
}

TEST(Glob, AgreesWithItsDefinitionOnAllShortWords) {
  for (const std::string& glob : words("a*?")) {
    for (const std::string& name : words("ab")) EXPECT_EQ(glob_takes(glob, name), by_definition(glob, name)) << glob << name;
  }
}

TEST(Scene, NumbersMeshesAndJoinsNames) {
  Scene scene;
  EXPECT_EQ(scene.add(group("street")), 0);
  EXPECT_EQ(scene.add(with_mesh("wall", 0)), 1);
  EXPECT_EQ(scene.add(group("group", 0)), 2);
  EXPECT_EQ(scene.add(with_mesh("arm", 2)), 3);
  EXPECT_EQ(scene.add(with_mesh("plate")), 4);
  EXPECT_EQ(scene.mesh_names(), (std::vector<std::string>{"street/wall", "street/group/arm", "plate"}));
  EXPECT_EQ(scene.meshes()[1].node, 3);
  EXPECT_EQ(scene.meshes()[1].object, 0);
  EXPECT_EQ(scene.meshes()[2].object, 4);
  EXPECT_EQ(scene.num_triangles(), 3);
  EXPECT_EQ(scene.find("street/group"), 2);
  EXPECT_EQ(scene.find("group"), std::nullopt);
  EXPECT_EQ(scene.node_of(1).name, "street/group/arm");
}

TEST(Scene, RefusesBadNodesByNameAndStaysAsItWas) {
  Scene scene;
  scene.add(with_mesh("wall"));
  for (const std::string name : {"a/b", "a*", "a?", "it's", "\"a\""}) {
    expect_error<Invalid>([&] { scene.add(group(name)); }, {"name", "free of", name});
  }
  expect_error<Invalid>([&] { scene.add(group("a\x1e")); }, {"name", "free of", "'a\\x1e'"});
  expect_error<Invalid>([&] { scene.add(group("\x1fz")); }, {"name", "free of", "'\\x1fz'"});
  for (const std::string name : {" a", "a\t", "\n"}) expect_error<Invalid>([&] { scene.add(group(name)); }, {"white space"});
  expect_error<Invalid>([&] { scene.add(group("")); }, {"name", "empty"});
  expect_error<Invalid>([&] { scene.add(group("wall")); }, {"name", "unique", "wall"});
  expect_error<Invalid>([&] { scene.add(group("x", 7)); }, {"parent", "got 7"});
  expect_error<Invalid>([&] { scene.add(group("x", -2)); }, {"parent", "got -2"});
  Node no_material = with_mesh("x"), no_mesh = group("x"), flat = group("x"), unsound = with_mesh("x");
  no_material.material = nullptr;
  no_mesh.material = std::make_shared<const Material>(Material::metal());
  flat.placement.linear().col(2).setZero();
  unsound.material = std::make_shared<const Material>();
  expect_error<Invalid>([&] { scene.add(no_material); }, {"material", "x"});
  expect_error<Invalid>([&] { scene.add(no_mesh); }, {"material", "without a mesh"});
  expect_error<Invalid>([&] { scene.add(flat); }, {"placement", "flatten"});
  EXPECT_THROW(scene.add(unsound), Invalid);
  flat.placement.translation().x() = std::numeric_limits<double>::quiet_NaN();
  expect_error<Invalid>([&] { scene.add(flat); }, {"placement", "finite"});
  EXPECT_EQ(scene.nodes().size(), 1u);
  EXPECT_EQ(scene.add(group("x")), 1);
}

TEST(Scene, ASequenceNeedsTheVerticesTheMeshWasMadeFrom) {
  // A bow tie is cut: 6 vertices from 5 of the input, which has a sixth that nothing uses.
  const std::vector<Vec3> vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {9, 9, 9}, {-1, 0, 0}, {-1, -1, 0}};
  const auto mesh = std::make_shared<const Mesh>(vertices, std::vector<Triangle>{{0, 1, 2}, {0, 4, 5}});
  std::vector<Vec3> moved = vertices;
  for (Vec3& vertex : moved) vertex += Vec3(0, 0, 2);
  Node node = with_mesh("tie", -1, mesh);
  node.deformation =
      std::make_shared<const VertexSequence>(std::vector<double>{0, 1}, std::vector<std::vector<Vec3>>{vertices, moved});
  Scene scene;
  scene.add(node);
  const std::vector<Vec3> half_way = world_vertices(scene, 0, 0.5);
  ASSERT_EQ(half_way.size(), 6u);
  for (size_t i = 0; i < 6; ++i) EXPECT_EQ(half_way[i], vertices[mesh->original_vertex()[i]] + Vec3(0, 0, 1));

  node.name = "other";
  const std::vector<Vec3> five(5, Vec3::Zero());
  node.deformation =
      std::make_shared<const VertexSequence>(std::vector<double>{0, 1}, std::vector<std::vector<Vec3>>{five, five});
  expect_error<Invalid>([&] { scene.add(node); }, {"deformation", "6 vertices", "got 5"});
  node = group("bare");
  node.deformation =
      std::make_shared<const VertexSequence>(std::vector<double>{0, 1}, std::vector<std::vector<Vec3>>{five, five});
  expect_error<Invalid>([&] { scene.add(node); }, {"deformation", "without a mesh"});
}

TEST(Scene, KnowsWhatMoves) {
  Scene scene;
  Node car = group("car");
  car.motion = std::make_shared<const LinearMotion>(Vec3(1, 0, 0));
  scene.add(car);
  scene.add(with_mesh("wheel", 0));
  scene.add(with_mesh("wall"));
  EXPECT_TRUE(scene.is_moving(0));
  EXPECT_FALSE(scene.is_moving(1));
}

std::shared_ptr<const Motion> keyframes(const std::vector<double>& times) {
  return std::make_shared<const KeyframeMotion>(times, std::vector<Vec3>(times.size(), Vec3::Zero()),
                                                std::vector<Quaternion>{}, Interpolation::kLinear);
}

TEST(Scene, JoinsBreakpointsAndNamesTheMotionThatIsTooShort) {
  Scene scene;
  Node one = group("one"), two = group("two");
  one.motion = keyframes({0, 0.5, 0.75, 1}), two.motion = keyframes({-1, 0.25, 0.5, 3});
  scene.add(one), scene.add(two);
  EXPECT_EQ(scene.breakpoints(), (std::vector<double>{0.25, 0.5, 0.75}));
  EXPECT_NO_THROW(scene.require_times(0.0, 1.0));
  EXPECT_NO_THROW(scene.require_times(0.0, 1.0 + 1e-15));
  expect_error<Invalid>([&] { scene.require_times(0.0, 1.5); }, {"motion", "node one", "0 to 1 s"});
  expect_error<Invalid>([&] { scene.require_times(-0.1, 1.0); }, {"node one"});
}

}  // namespace
}  // namespace echopath::test_scene
