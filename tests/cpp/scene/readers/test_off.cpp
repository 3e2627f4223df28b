#include <gtest/gtest.h>

#include "mesh_files.h"

namespace echopath::test_off {
namespace {

const std::string kSquare = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

MeshPtr read(const std::string& content) { return test::read_meshes("mesh.off", content).at(0).mesh; }

void expect_refused(const std::string& content, std::initializer_list<std::string> pieces) {
  test::expect_refused("broken.off", content, {"echopath_broken.off, line"});
  test::expect_refused("broken.off", content, pieces);
}

TEST(Off, ReadsFacesOfAnySizeInTheirOrder) {
  const MeshPtr mesh = read("OFF\n4 1 4\n" + kSquare + "4 0 1 2 3\n");
  EXPECT_EQ(mesh->vertices(), (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh->triangles(), (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(mesh->original_triangle(), (std::vector<uint32_t>{0, 0}));
}

TEST(Off, HeadsOfModelNetCommentsAndColoursAreRead) {
  EXPECT_DOUBLE_EQ(read("OFF4 1 0\n" + kSquare + "4 0 1 2 3\n")->area(), 1.0);
  EXPECT_DOUBLE_EQ(read("# by hand\nOFF 4 1 0\n\n" + kSquare + "4 0 1 2 3 # a square\n")->area(), 1.0);
  EXPECT_DOUBLE_EQ(
      read("COFF\r\n3 1 0\r\n0 0 0 255 0 0 1\r\n2 0 0 1 1 1 1\r\n0 1 0 9 9 9 1\r\n3 0 1 2 0.5 0.5 0.5\r\n")->area(), 1.0);
}

TEST(Off, WhatIsMissingOrWrongIsToldByItsLine) {
  expect_refused("PLY\n", {"line 1", "must begin with OFF"});
  expect_refused("4OFF\n1 0 0\n", {"line 1", "in three dimensions"});
  expect_refused("OFF BINARY\n", {"binary"});
  expect_refused("OFF\n4 one 0\n", {"line 2", "number of faces must be a whole number, got 'one'"});
  expect_refused("OFF\n4294967295 4294967295 0\n0 0 0\n", {"ends too early, before vertex 1 of 4294967295"});
  expect_refused("OFF\n4 2 0\n" + kSquare + "3 0 1 2\n", {"before face 1 of 2"});
  expect_refused("OFF\n4 1 0\n" + kSquare + "2 0 1\n", {"line 7", "needs 3 corners, it has 2"});
  expect_refused("OFF\n4 1 0\n" + kSquare + "3 0 1 4\n", {"line 7", "vertex 4 does not exist, there are 4"});
  expect_refused("OFF\n4 1 0\n" + kSquare + "3 0 1 -1\n", {"line 7", "'-1'"});
  expect_refused("OFF\n4 1 0\n0 0 nan\n", {"line 3", "nan"});
}

}  // namespace
}  // namespace echopath::test_off
