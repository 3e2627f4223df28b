#include <gtest/gtest.h>

#include "echopath/scene/smooth/kept_normals.h"
#include "echopath/scene/smooth/smooth.h"

namespace echopath::test_kept_normals {
namespace {

// A square pyramid whose top is at that height.
MeshPtr pyramid(double height) {
  const std::vector<Vec3> vertices = {{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}, {0, 0, height}};
  const std::vector<Triangle> triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  return std::make_shared<const Mesh>(Mesh(vertices, triangles));
}

TEST(KeptNormals, AreThoseOfTheMeshAndMadeOnce) {
  const MeshPtr mesh = pyramid(1.0);
  const auto kept = kept_vertex_normals(mesh);
  EXPECT_EQ(*kept, vertex_normals(*mesh));
  EXPECT_LT((kept->back() - Vec3::UnitZ()).norm(), 1e-15);  // by symmetry
  EXPECT_EQ(kept_vertex_normals(mesh), kept);
}

// Meshes that come after others are gone often lie where these were.
TEST(KeptNormals, AreNotThoseOfAMeshThatWasThereBefore) {
  for (int i = 1; i < 1000; ++i) {
    const MeshPtr mesh = pyramid(0.01 * i);
    ASSERT_EQ(*kept_vertex_normals(mesh), vertex_normals(*mesh)) << i;
  }
}

}  // namespace
}  // namespace echopath::test_kept_normals
