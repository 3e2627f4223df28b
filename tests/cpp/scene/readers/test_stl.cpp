#include <gtest/gtest.h>

#include <bit>

#include "mesh_files.h"

namespace echopath::test_stl {
namespace {

using Facet = std::array<Vec3, 3>;

// A unit square of two facets that share a diagonal; all coordinates are floats.
const std::vector<Facet> kSquare = {{Vec3(0, 0, 0.25), Vec3(1, 0, 0.25), Vec3(1, 1, 0.25)},
                                    {Vec3(0, 0, 0.25), Vec3(1, 1, 0.25), Vec3(0, 1, 0.25)}};

void put(std::string& bytes, uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xFF);
}

std::string binary(const std::vector<Facet>& facets, uint32_t count, std::string head = "made by a test") {
  head.resize(80, ' ');
  put(head, count);
  for (const Facet& facet : facets) {
    for (int i = 0; i < 3; ++i) put(head, 0);  // the normal, which readers work out themselves
    for (const Vec3& point : facet) {
      for (const double value : point) put(head, std::bit_cast<uint32_t>(static_cast<float>(value)));
    }
    head += std::string(2, '\0');
  }
  return head;
}

std::string text(const std::vector<Facet>& facets, const std::string& name) {
  std::string lines = "solid " + name + "\n";
  for (const Facet& facet : facets) {
    lines += " facet normal 0 0 1\n  outer loop\n";
    for (const Vec3& p : facet) {
      lines += "   vertex " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
    }
    lines += "  endloop\n endfacet\n";
  }
  return lines + "endsolid " + name + "\n";
}

std::vector<NamedMesh> read(const std::string& content) { return test::read_meshes("mesh.stl", content); }

void expect_refused(const std::string& content, std::initializer_list<std::string> pieces) {
  test::expect_refused("broken.stl", content, pieces);
}

void expect_square(const Mesh& mesh) {
  EXPECT_EQ(mesh.vertices(), (std::vector<Vec3>{{0, 0, 0.25}, {1, 0, 0.25}, {1, 1, 0.25}, {0, 1, 0.25}}));
  EXPECT_EQ(mesh.triangles(), (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Stl, BinaryAndTextGiveTheSameMeshWithSharedVertices) {
  const std::vector<NamedMesh> from_binary = read(binary(kSquare, 2)), from_text = read(text(kSquare, "plate"));
  ASSERT_EQ(from_binary.size(), 1u);
  ASSERT_EQ(from_text.size(), 1u);
  expect_square(*from_binary[0].mesh);
  expect_square(*from_text[0].mesh);
  EXPECT_EQ(from_binary[0].name, "echopath_mesh");
  EXPECT_EQ(from_text[0].name, "plate");
}

TEST(Stl, ABinaryFileMayBeginWithSolidAndEndWithMoreBytes) {
  expect_square(*read(binary(kSquare, 2, "solid as some programs write it"))[0].mesh);
  expect_square(*read(binary(kSquare, 2) + "more")[0].mesh);
}

TEST(Stl, EachSolidOfATextIsAMeshAndCaseDoesNotCount) {
  const std::vector<NamedMesh> meshes = read(text(kSquare, "a b") + text({kSquare[0]}, "") + text({kSquare[1]}, "a b"));
  ASSERT_EQ(meshes.size(), 2u);
  EXPECT_EQ(meshes[0].name, "a b");
  EXPECT_EQ(meshes[0].mesh->triangles().size(), 3u);
  EXPECT_EQ(meshes[1].name, "echopath_mesh");
  std::string upper = text(kSquare, "X");
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  expect_square(*read(upper)[0].mesh);
}

TEST(Stl, BlankLinesMayComeBeforeTheFirstSolid) {
  for (const char* before : {"\n", "\r\n \t\n", "  "}) EXPECT_EQ(read(before + text(kSquare, "a"))[0].name, "a");
}

TEST(Stl, ZerosOfBothSignsAreOneVertex) {
  const std::string content =
      "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\n"
      "endfacet\nfacet normal 0 0 1\nouter loop\nvertex -0 0 -0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
  EXPECT_EQ(read(content)[0].mesh->vertices().size(), 4u);
}

TEST(Stl, WhatIsMissingOrWrongIsToldByItsPlace) {
  expect_refused(binary(kSquare, 3), {"ends too early", "3 triangles", "has 2"});
  expect_refused(binary(kSquare, 0xFFFFFFFFu), {"4294967295 triangles"});
  expect_refused("short", {"84 bytes"});
  expect_refused("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", {"line 4", "within a facet"});
  expect_refused("solid a\nouter loop\nvertex 0 0 x\n", {"line 3", "not a number: 'x'"});
  expect_refused("solid a\nouter loop\nvertex 0 0 1e400\n", {"line 3", "1e400"});
  expect_refused("solid a\nouter loop\nvertex 0 0\n", {"line 3", "3 numbers"});
  expect_refused("solid a\nouter loop\nvertex 0 0 0\nendloop\n", {"line 4", "needs 3 vertices, it has 1"});
  expect_refused("solid a\nvertex 0 0 0\n", {"line 2", "within an outer loop"});
  expect_refused("solid a\nfacets\n", {"line 2", "facets"});
  expect_refused("solid a\nendsolid a\n", {"has no faces"});
  const std::string facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\n";
  expect_refused("solid a\n" + facet + facet, {"line 15", "before the endsolid"});  // cut between two facets
  std::vector<Facet> broken = kSquare;
  broken[1][2].y() = std::nan("");
  expect_refused(binary(broken, 2), {"triangle 1", "not a number"});
}

}  // namespace
}  // namespace echopath::test_stl
