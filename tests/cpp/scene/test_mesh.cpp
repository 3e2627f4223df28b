#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "cpp/support/expect_error.h"
#include "echopath/scene/mesh/mesh.h"

namespace echopath::test_mesh {
namespace {

using test::expect_error;
using Invalid = std::invalid_argument;

const std::vector<Vec3> kCube = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
const std::vector<Triangle> kCubeFaces = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                                          {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};

// By Heron's formula, which shares nothing with the mesh.
double area_of(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  double total = 0.0;
  for (const Triangle& t : triangles) {
    const double a = (vertices[t[0]] - vertices[t[1]]).norm(), b = (vertices[t[1]] - vertices[t[2]]).norm(),
                 c = (vertices[t[2]] - vertices[t[0]]).norm(), s = 0.5 * (a + b + c);
    total += std::sqrt(s * (s - a) * (s - b) * (s - c));
  }
  return total;
}

// Every edge has one face, or two that run through it in opposite directions; the faces of a vertex form one fan.
void expect_manifold(const Mesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> sides;
  std::map<uint32_t, std::vector<std::pair<uint32_t, uint32_t>>> opposite_sides;  // of each vertex
  for (const Triangle& t : mesh.triangles()) {
    for (size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(++sides[std::make_pair(t[k], t[(k + 1) % 3])], 1) << "two faces run through an edge in the same direction";
      opposite_sides[t[k]].push_back({t[(k + 1) % 3], t[(k + 2) % 3]});
    }
  }
  for (auto& [vertex, open] : opposite_sides) {  // grow the fan of the first face until nothing more fits
    std::set<uint32_t> rim = {open[0].first, open[0].second};
    open.erase(open.begin());
    for (size_t i = 0; i < open.size();) {
      if (!rim.contains(open[i].first) && !rim.contains(open[i].second)) {
        ++i;
        continue;
      }
      rim.insert(open[i].first), rim.insert(open[i].second);
      open.erase(open.begin() + static_cast<std::ptrdiff_t>(i));
      i = 0;
    }
    EXPECT_TRUE(open.empty()) << "vertex " << vertex << " has more than one fan";
  }
}

// All faces are there, in order, on the same points, and the result is a manifold.
void expect_all_kept(const Mesh& mesh, const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  ASSERT_EQ(mesh.triangles().size(), triangles.size());
  for (size_t t = 0; t < triangles.size(); ++t) {
    EXPECT_EQ(mesh.original_triangle()[t], t);
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t vertex = mesh.triangles()[t][k];
      EXPECT_EQ(mesh.vertices()[vertex], vertices[triangles[t][k]]);
      EXPECT_EQ(mesh.original_vertex()[vertex], triangles[t][k]);
    }
  }
  EXPECT_NEAR(mesh.area(), area_of(vertices, triangles), 1e-12);  // rounding of sums near 10
  EXPECT_EQ(mesh.num_removed_triangles(), 0);
  expect_manifold(mesh);
}

TEST(Mesh, KeepsAManifoldAsItIs) {
  const Mesh cube(kCube, kCubeFaces);
  expect_all_kept(cube, kCube, kCubeFaces);
  EXPECT_EQ(cube.vertices(), kCube);
  EXPECT_EQ(cube.triangles(), kCubeFaces);
  EXPECT_EQ(cube.num_duplicated_vertices(), 0);
  EXPECT_DOUBLE_EQ(cube.area(), 6.0);
}

TEST(Mesh, IsClosedOnlyWithoutABoundary) {
  EXPECT_TRUE(Mesh(kCube, kCubeFaces).is_closed());
  std::vector<Triangle> open = kCubeFaces;
  open.pop_back();
  EXPECT_FALSE(Mesh(kCube, open).is_closed());
}

TEST(Mesh, KeepsThreeFacesOnOneEdge) {
  const std::vector<Vec3> vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}};
  const std::vector<Triangle> fan = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  const Mesh mesh(vertices, fan);
  expect_all_kept(mesh, vertices, fan);
  EXPECT_GT(mesh.num_duplicated_vertices(), 0);
  EXPECT_FALSE(mesh.is_closed());
}

TEST(Mesh, KeepsBothSidesOfABowTie) {
  const std::vector<Vec3> vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
  const std::vector<Triangle> bow_tie = {{0, 1, 2}, {0, 3, 4}};
  const Mesh mesh(vertices, bow_tie);
  expect_all_kept(mesh, vertices, bow_tie);
  EXPECT_EQ(mesh.num_duplicated_vertices(), 1);
  EXPECT_EQ(mesh.original_vertex().back(), 0u);
}

TEST(Mesh, KeepsAFaceThatIsThereTwice) {
  const std::vector<Triangle> twice = {{0, 1, 2}, {0, 1, 2}, {2, 1, 0}};
  expect_all_kept(Mesh(kCube, twice), kCube, twice);
}

TEST(Mesh, KeepsAnInvertedFace) {
  std::vector<Triangle> faces = kCubeFaces;
  std::swap(faces[5][0], faces[5][1]);
  const Mesh mesh(kCube, faces);
  expect_all_kept(mesh, kCube, faces);
  EXPECT_EQ(mesh.num_duplicated_vertices(), 3);
}

TEST(Mesh, KeepsAllOfAMoebiusStrip) {
  for (const uint32_t n : {3u, 4u, 5u, 12u}) {
    std::vector<Vec3> vertices;
    std::vector<Triangle> strip;
    for (uint32_t i = 0; i < n; ++i) {
      const double angle = 6.283185307179586 * i / n;
      const Vec3 outwards(std::cos(angle), std::sin(angle), 0);
      const Vec3 across = 0.3 * (outwards * std::cos(angle / 2) + Vec3::UnitZ() * std::sin(angle / 2));
      vertices.push_back(outwards + across), vertices.push_back(outwards - across);
      const bool last = i + 1 == n;  // comes back turned over
      const uint32_t a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
      strip.push_back({a, b, c}), strip.push_back({b, d, c});
    }
    expect_all_kept(Mesh(vertices, strip), vertices, strip);
  }
}

TEST(Mesh, KeepsAllOfARandomSoup) {
  uint32_t state = 1;
  const auto next = [&](uint32_t count) { return (state = state * 1664525u + 1013904223u) / 65536u % count; };
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<Vec3> vertices;
    for (uint32_t i = 0; i < 8; ++i) vertices.push_back(Vec3(std::cos(i * i), std::sin(3.0 * i), 0.3 * i));
    std::vector<Triangle> soup;
    while (soup.size() < 20) {
      const Triangle t = {next(8), next(8), next(8)};
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) soup.push_back(t);
    }
    const Mesh mesh(vertices, soup);
    expect_all_kept(mesh, vertices, soup);
  }
}

TEST(Mesh, RemovesAndCountsTrianglesWithoutArea) {
  const std::vector<Vec3> vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {0.5, 1e-13, 0}, {0.5, 1e-9, 0}};
  // two corners equal; three in a line; flatter than 1e-12; thin but a triangle
  const std::vector<Triangle> triangles = {{0, 0, 1}, {0, 1, 3}, {0, 1, 2}, {0, 1, 4}, {0, 1, 5}};
  const Mesh mesh(vertices, triangles);
  EXPECT_EQ(mesh.num_removed_triangles(), 3);
  EXPECT_EQ(mesh.original_triangle(), (std::vector<uint32_t>{2, 4}));
}

TEST(Mesh, RefusesVerticesOfTrianglesThatAreNotFinite) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e71}) {
    const std::vector<Vec3> vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, bad, 0}};
    expect_error<std::invalid_argument>([&] { Mesh(vertices, {{0, 1, 2}, {0, 1, 3}}); },
                                        {"vertices: vertex 3 must be finite"});
    EXPECT_EQ(Mesh(vertices, {{0, 1, 2}}).triangles().size(), 1);  // what no triangle uses does no harm
  }
}

TEST(Mesh, LeavesOutVerticesThatNoFaceUses) {
  const std::vector<Vec3> vertices = {{9, 9, 9}, {0, 0, 0}, {8, 8, 8}, {1, 0, 0}, {0, 1, 0}, {1e9, 0, 0}};
  const Mesh mesh(vertices, {{4, 1, 3}});
  EXPECT_EQ(mesh.original_vertex(), (std::vector<uint32_t>{1, 3, 4}));
  EXPECT_EQ(mesh.triangles(), (std::vector<Triangle>{{2, 0, 1}}));
  EXPECT_EQ(mesh.num_input_vertices(), 6);
}

TEST(Mesh, ComesOutTheSameWhenMadeFromItself) {
  const std::vector<Triangle> fan = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {5, 6, 7}};
  const Mesh once(kCube, fan);
  const Mesh twice(once.vertices(), once.triangles());
  EXPECT_EQ(twice.vertices(), once.vertices());
  EXPECT_EQ(twice.triangles(), once.triangles());
  EXPECT_EQ(twice.num_duplicated_vertices(), 0);
}

TEST(Mesh, KeepsTheAreaOfATriangleFarFromTheOrigin) {
  const Vec3 far(5.4e6, -5.4e6, 5.4e6);
  const Mesh mesh({far, far + Vec3(2, 0, 0), far + Vec3(0, 3, 0)}, {{0, 1, 2}});
  EXPECT_NEAR(mesh.area(), 3.0, 1e-8);  // coordinates of 5.4e6 m are spaced by 1e-9 m
}

TEST(Mesh, RefusesBadInputByName) {
  expect_error<Invalid>([&] { Mesh(kCube, {{0, 1, 8}}); }, {"triangles", "number of vertices, 8", "got 8"});
  expect_error<Invalid>([&] { Mesh(kCube, {}); }, {"triangles", "area"});
  expect_error<Invalid>([&] { Mesh(kCube, {{0, 1, 1}}); }, {"triangles", "area"});
  expect_error<Invalid>([&] { Mesh({}, {{0, 1, 2}}); }, {"triangles", "got 0"});
  expect_error<Invalid>([&] { Mesh(kCube, kCubeFaces, {1, 2}); }, {"original_triangle", "got 2"});
}

}  // namespace
}  // namespace echopath::test_mesh
