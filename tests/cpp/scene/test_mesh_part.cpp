// A surface cut into parts loses nothing, and its normals know nothing of the cut.
#include <gtest/gtest.h>

#include <numeric>

#include "cpp/support/boxes.h"
#include "cpp/support/expect_error.h"
#include "echopath/scene/mesh/surface_patch.h"
#include "echopath/scene/readers/skin_parts.h"
#include "echopath/scene/scene.h"
#include "echopath/scene/smooth/smooth.h"

namespace echopath::test_mesh_part {
namespace {

using test::expect_error;
using testing::box_corners;
using testing::kBoxTriangles;
using Invalid = std::invalid_argument;

// A wavy sheet of n x n squares, and one sheet more on an inner edge, which makes that edge non-manifold.
MeshPtr sheet(uint32_t n) {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  for (uint32_t i = 0; i <= n; ++i) {
    for (uint32_t j = 0; j <= n; ++j) vertices.emplace_back(i, j, 0.2 * std::sin(i + 0.7 * j));
  }
  for (uint32_t i = 0; i < n; ++i) {
    for (uint32_t j = 0; j < n; ++j) {
      const uint32_t a = i * (n + 1) + j, b = a + n + 1;
      triangles.push_back({a, b, b + 1});
      triangles.push_back({a, b + 1, a + 1});
    }
  }
  vertices.emplace_back(2, 2, 3);
  triangles.push_back({2 * (n + 1) + 1, 2 * (n + 1) + 2, static_cast<uint32_t>(vertices.size() - 1)});
  return std::make_shared<const Mesh>(vertices, triangles);
}

MeshPtr cube() { return std::make_shared<const Mesh>(box_corners(Vec3::Zero(), Vec3::Ones()), kBoxTriangles); }

std::vector<uint32_t> from_to(uint32_t begin, uint32_t end) {
  std::vector<uint32_t> range(end - begin);
  std::iota(range.begin(), range.end(), begin);
  return range;
}

TEST(MeshPart, TrianglesStandWhereTheyStoodInTheWhole) {
  const MeshPtr whole = sheet(5);
  ASSERT_GT(whole->num_duplicated_vertices(), 0);
  const MeshPtr part = Mesh::part(whole, {50, 7, 20, 7});
  EXPECT_EQ(part->whole(), whole);
  EXPECT_EQ(part->whole_triangle(), (std::vector<uint32_t>{7, 20, 50}));
  EXPECT_EQ(part->num_input_vertices(), whole->num_input_vertices());
  for (size_t t = 0; t < 3; ++t) {
    const uint32_t before = part->whole_triangle()[t];
    EXPECT_EQ(part->original_triangle()[t], whole->original_triangle()[before]);
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t corner = part->triangles()[t][k], there = whole->triangles()[before][k];
      EXPECT_EQ(part->whole_vertex()[corner], there);
      EXPECT_EQ(part->original_vertex()[corner], whole->original_vertex()[there]);
      EXPECT_EQ(part->vertices()[corner], whole->vertices()[there]);
    }
  }
}

TEST(MeshPart, ThePartOfAPartIsOneOfTheWhole) {
  const MeshPtr whole = sheet(4);
  const MeshPtr part = Mesh::part(Mesh::part(whole, from_to(10, 30)), {0, 5});
  EXPECT_EQ(part->whole(), whole);
  EXPECT_EQ(part->whole_triangle(), (std::vector<uint32_t>{10, 15}));
}

TEST(MeshPart, IsClosedOnlyWithoutABoundary) {
  EXPECT_TRUE(cube()->is_closed());
  EXPECT_TRUE(Mesh::part(cube(), from_to(0, 12))->is_closed());
  EXPECT_FALSE(Mesh::part(cube(), from_to(0, 11))->is_closed());
}

TEST(MeshPart, RefusesWhatIsNotThere) {
  expect_error<Invalid>([] { Mesh::part(cube(), {}); }, {"triangles", "one at least"});
  expect_error<Invalid>([] { Mesh::part(cube(), {12}); }, {"triangles", "got 12"});
}

TEST(MeshPart, NormalsAtTheRimAreThoseOfTheWhole) {
  const MeshPtr whole = sheet(5);
  const std::vector<Vec3> all = vertex_normals(*whole);
  const MeshPtr part = Mesh::part(whole, from_to(12, 31));
  const std::vector<Vec3> normals = vertex_normals(*part);
  for (size_t v = 0; v < normals.size(); ++v) EXPECT_EQ(normals[v], all[part->whole_vertex()[v]]);
}

TEST(SurfacePatch, PosesTheRingAndGivesTheNormalsOfAll) {
  const MeshPtr whole = sheet(12);
  const std::vector<Vec3> all = vertex_normals(*whole);
  for (const MeshPtr& mesh : {whole, Mesh::part(whole, from_to(100, 200))}) {
    std::vector<uint8_t> takes(mesh->triangles().size(), 0);
    takes[3] = takes[90] = 1;
    const SurfacePatch patch = make_patch(*mesh, takes, true);
    EXPECT_LT(patch.original_vertex.size(), 40u);  // two rings of at most 18 and the corners between
    std::vector<Vec3> vertices;
    for (const uint32_t v : patch.original_vertex) vertices.push_back(whole->vertices()[v]);
    const std::vector<Vec3> normals = vertex_normals(vertices, patch.triangles);
    for (const size_t t : {size_t{3}, size_t{90}}) {
      const Triangle corners = patch.corners(mesh->triangles()[t]);
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t there = mesh->surface_vertex(mesh->triangles()[t][k]);
        EXPECT_EQ(vertices[corners[k]], whole->vertices()[there]);
        EXPECT_EQ(normals[corners[k]], all[there]);
      }
    }
  }
}

TEST(SurfacePatch, WithoutNormalsItIsTheCornersAlone) {
  const MeshPtr mesh = sheet(4);
  std::vector<uint8_t> takes(mesh->triangles().size(), 0);
  takes[0] = takes[1] = 1;
  const SurfacePatch patch = make_patch(*mesh, takes, false);
  EXPECT_EQ(patch.original_vertex.size(), 4u);
  EXPECT_TRUE(patch.triangles.empty());
  EXPECT_EQ(patch.place.back(), SurfacePatch::kAbsent);
}

// Left and right half of the sheet follow joints of their own.
Skin halves(const Mesh& mesh, uint32_t num_vertices) {
  SkinWeights weights{1, std::vector<uint32_t>(num_vertices, 0), std::vector<double>(num_vertices, 1.0)};
  std::vector<Vec3> vertices(num_vertices, Vec3::Zero());
  for (size_t v = 0; v < mesh.vertices().size(); ++v) {
    vertices[mesh.original_vertex()[v]] = mesh.vertices()[v];
    weights.joint[mesh.original_vertex()[v]] = mesh.vertices()[v].x() > 2.5 ? 2 : 0;
  }
  return Skin(vertices,
              {Joint{"left", -1, Transform::Identity(), nullptr, {}}, Joint{"idle", 0, Transform::Identity(), nullptr, {}},
               Joint{"right", 0, Transform::Identity(), nullptr, {}}},
              weights);
}

TEST(PartsByJoint, EveryTriangleIsInOnePart) {
  const MeshPtr mesh = sheet(5);
  const std::vector<NamedMesh> parts = parts_by_joint(mesh, halves(*mesh, 37));
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].name, "left");
  EXPECT_EQ(parts[1].name, "right");
  std::vector<int> count(mesh->triangles().size(), 0);
  for (const NamedMesh& part : parts) {
    for (const uint32_t t : part.mesh->whole_triangle()) ++count[t];
  }
  EXPECT_EQ(count, std::vector<int>(mesh->triangles().size(), 1));
  expect_error<Invalid>([&] { parts_by_joint(cube(), halves(*mesh, 37)); }, {"skin", "8 vertices", "got 37"});
}

}  // namespace
}  // namespace echopath::test_mesh_part
