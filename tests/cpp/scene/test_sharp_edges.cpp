#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "echopath/base/constants.h"
#include "echopath/scene/edges/sharp_edges.h"

namespace echopath::test_sharp_edges {
namespace {

struct Soup {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;

  // Adds a quadrilateral with corners of its own.
  void add_quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const auto first = static_cast<uint32_t>(vertices.size());
    vertices.insert(vertices.end(), {a, b, c, d});
    triangles.push_back({first, first + 1, first + 2});
    triangles.push_back({first, first + 2, first + 3});
  }
  Mesh mesh() const { return {vertices, triangles}; }
};

// Adds a box from the origin to `size` whose faces share no vertices.
Soup box(const Vec3& size) {
  Soup soup;
  const auto at = [&](int x, int y, int z) { return Vec3(x * size[0], y * size[1], z * size[2]); };
  soup.add_quad(at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0));
  soup.add_quad(at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1));
  soup.add_quad(at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1));
  soup.add_quad(at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0));
  soup.add_quad(at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0));
  soup.add_quad(at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1));
  return soup;
}

double length_of(const Mesh& mesh, const SharpEdge& edge) {
  const Triangle& corners = mesh.triangles()[edge.triangle];
  return (edge.end - edge.begin) *
         (mesh.vertices()[corners[(edge.side + 1) % 3]] - mesh.vertices()[corners[edge.side]]).norm();
}

double total_length(const Mesh& mesh, const std::vector<SharpEdge>& edges) {
  double total = 0.0;
  for (const SharpEdge& edge : edges) total += length_of(mesh, edge);
  return total;
}

double exterior_of(const SharpEdge& edge) {
  const double angle = std::atan2(edge.inward[1].dot(edge.normal[0]), edge.inward[1].dot(edge.inward[0]));
  return angle > 1e-9 ? angle : angle + kTwoPi;
}

TEST(SharpEdges, ABoxHasTwelveOfThreeQuartersOfACircle) {
  const Mesh mesh = box({1, 2, 3}).mesh();
  const std::vector<SharpEdge> edges = find_sharp_edges(mesh);
  ASSERT_EQ(edges.size(), 12u);
  EXPECT_NEAR(total_length(mesh, edges), 24.0, 1e-12);
  const Vec3 middle(0.5, 1.0, 1.5);
  for (const SharpEdge& edge : edges) {
    EXPECT_NEAR(exterior_of(edge), 1.5 * kPi, 1e-12);
    const Vec3& corner = mesh.vertices()[mesh.triangles()[edge.triangle][edge.side]];
    for (int face = 0; face < 2; ++face) {
      EXPECT_GT(edge.normal[face].dot(corner - middle), 0.0);  // outward
      EXPECT_LT(edge.inward[face].dot(corner - middle), 0.0);
    }
  }
}

// Windings do not count: neither those of all faces nor of one.
TEST(SharpEdges, WindingsDoNotCount) {
  Soup soup = box({1, 1, 1});
  for (const size_t turned : {2, 3, 7}) std::swap(soup.triangles[turned][0], soup.triangles[turned][1]);
  const Mesh mesh = soup.mesh();
  const std::vector<SharpEdge> edges = find_sharp_edges(mesh);
  ASSERT_EQ(edges.size(), 12u);
  for (const SharpEdge& edge : edges) EXPECT_NEAR(exterior_of(edge), 1.5 * kPi, 1e-12);
}

TEST(SharpEdges, ASheetHasItsRim) {
  Soup soup;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 2; ++k) {
      const auto at = [&](int x, int y) { return Vec3(0.7 * (i + x), 0.5 * (k + y), 0.2); };
      soup.add_quad(at(0, 0), at(1, 0), at(1, 1), at(0, 1));
    }
  }
  const Mesh mesh = soup.mesh();
  const std::vector<SharpEdge> edges = find_sharp_edges(mesh);
  EXPECT_EQ(edges.size(), 10u);
  EXPECT_NEAR(total_length(mesh, edges), 2.0 * (2.1 + 1.0), 1e-12);
  for (const SharpEdge& edge : edges) {
    EXPECT_NEAR(exterior_of(edge), kTwoPi, 1e-12);
    EXPECT_LT((edge.normal[0] + edge.normal[1]).norm(), 1e-12);
    EXPECT_LT((edge.inward[0] - edge.inward[1]).norm(), 1e-12);
  }
}

// One long face meets three short ones whose corners lie on its side.
TEST(SharpEdges, SidesThatMeetSeveralOthersAreConnected) {
  Soup soup;
  soup.add_quad({0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0});
  for (const auto& [from, to] : {std::pair(0.0, 0.7), std::pair(0.7, 1.9), std::pair(1.9, 3.0)})
    soup.add_quad({from, 0, 0}, {to, 0, 0}, {to, 0, 1}, {from, 0, 1});
  const Mesh mesh = soup.mesh();
  double folded = 0.0, rims = 0.0;
  for (const SharpEdge& edge : find_sharp_edges(mesh)) {
    if (std::abs(exterior_of(edge) - 1.5 * kPi) < 1e-9) folded += length_of(mesh, edge);
    else rims += length_of(mesh, edge);
  }
  EXPECT_NEAR(folded, 3.0, 1e-9);
  EXPECT_NEAR(rims, 3.0 + 3.0 + 4.0, 1e-9);
}

// A face that is cut only halfway by another: the rest of its side is a rim.
TEST(SharpEdges, TheRestOfASideIsARim) {
  Soup soup;
  soup.add_quad({0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0});
  soup.add_quad({1, 0, 0}, {2, 0, 0}, {2, -1, 0.0}, {1, -1, 0.0});  // goes on in the same plane
  const Mesh mesh = soup.mesh();
  EXPECT_NEAR(total_length(mesh, find_sharp_edges(mesh)), 8.0 - 1.0 + 3.0, 1e-9);
}

// A fin on a plate parts the space about its foot into angles of which none is wider than half a circle.
TEST(SharpEdges, TheFootOfAFinIsNone) {
  Soup soup;
  soup.add_quad({-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0});
  soup.add_quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  soup.add_quad({0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1});
  const Mesh mesh = soup.mesh();
  EXPECT_NEAR(total_length(mesh, find_sharp_edges(mesh)), 6.0 + 3.0, 1e-9);
}

// A cylinder of 24 facets without lids: its facets turn by 15 degrees.
TEST(SharpEdges, FacetsOfARoundBodyAreNone) {
  Soup soup;
  const auto at = [](int i, double z) { return Vec3(std::cos(kTwoPi * i / 24), std::sin(kTwoPi * i / 24), z); };
  for (int i = 0; i < 24; ++i) soup.add_quad(at(i, 0), at(i + 1, 0), at(i + 1, 2), at(i, 2));
  const Mesh mesh = soup.mesh();
  const std::vector<SharpEdge> edges = find_sharp_edges(mesh);
  EXPECT_EQ(edges.size(), 48u);
  for (const SharpEdge& edge : edges) EXPECT_NEAR(exterior_of(edge), kTwoPi, 1e-9);
}

TEST(SharpEdges, APartHasThoseOfTheWholeAndNoRimWhereItIsCut) {
  const auto whole = std::make_shared<const Mesh>(box({1, 1, 1}).mesh());
  const MeshPtr lid = Mesh::part(whole, {2, 3}), half = Mesh::part(whole, {2});
  for (const SharpEdge& edge : find_sharp_edges(*lid)) EXPECT_NEAR(exterior_of(edge), 1.5 * kPi, 1e-12);
  EXPECT_EQ(find_sharp_edges(*half).size(), 2u);
}

TEST(SharpEdges, AMeshKeepsThem) {
  const Mesh mesh = box({1, 1, 1}).mesh();
  EXPECT_EQ(mesh.sharp_edges().size(), 12u);
  EXPECT_EQ(mesh.sharp_edges().data(), mesh.sharp_edges().data());
}

// Points that single precision names lie on the side, and the edge is found by them.
TEST(SharpEdges, PointsOnSidesLieOnThem) {
  const Mesh mesh = box({1, 1, 1}).mesh();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0.001, 0.999);
  for (const SharpEdge& edge : mesh.sharp_edges()) {
    for (int i = 0; i < 100; ++i) {
      const double along = unit(random);
      const PointOnSide point = point_on_side(edge.side, along);
      const Triangle& corners = mesh.triangles()[edge.triangle];
      const Vec3 &a = mesh.vertices()[corners[0]], &b = mesh.vertices()[corners[1]], &c = mesh.vertices()[corners[2]];
      const Vec3 at = a + double{point.u} * (b - a) + double{point.v} * (c - a);
      const Vec3 &from = mesh.vertices()[corners[edge.side]], &to = mesh.vertices()[corners[(edge.side + 1) % 3]];
      EXPECT_LT(distance_to_segment(at, from, to), 1e-15);
      EXPECT_LT((at - from - along * (to - from)).norm(), 1e-7);
      EXPECT_EQ(sharp_edge_at(mesh.sharp_edges(), edge.triangle, point.u, point.v), &edge);
    }
  }
  EXPECT_EQ(sharp_edge_at(mesh.sharp_edges(), 0, 0.25, 0.25 + 0.1), nullptr);
}

// A mesh of many facets takes no time to speak of: a rough grid whose lines are all parallel to two others.
TEST(SharpEdges, ALargeMeshIsSearchedOnce) {
  Soup soup;
  constexpr int kSide = 150;
  const auto at = [](int x, int y) { return Vec3(0.01 * x, 0.01 * y, (x + y) % 2 ? 0.01 : 0.0); };
  for (int x = 0; x < kSide; ++x) {
    for (int y = 0; y < kSide; ++y) soup.add_quad(at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
  }
  const Mesh mesh = soup.mesh();
  EXPECT_GT(find_sharp_edges(mesh).size(), 4u * kSide);
}

}  // namespace
}  // namespace echopath::test_sharp_edges
