#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "echopath/base/errors.h"
#include "echopath/scene/readers/readers.h"
#include "support/expect_error.h"
#include "temporary_file.h"

namespace echopath::test_obj {
namespace {

using test::expect_error;
using test::TemporaryFile;

constexpr double kRounding = 1e-12;

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::vector<NamedMesh> read(const std::string& content, double unit = 1.0) {
  const TemporaryFile file("mesh.obj", content);
  return load_meshes(file.path(), unit);
}

void expect_refused(const std::string& content, std::initializer_list<std::string> pieces) {
  const TemporaryFile file("broken.obj", content);
  expect_error<FileError>([&] { load_meshes(file.path()); }, {"echopath_broken.obj"});
  expect_error<FileError>([&] { load_mesh(file.path()); }, pieces);
}

TEST(Obj, ReadsTheFileWithoutGroupsUnderItsStem) {
  const std::vector<NamedMesh> meshes = read(kSquare + "f 1 2 3\nf 1 3 4\n");
  ASSERT_EQ(meshes.size(), 1u);
  EXPECT_EQ(meshes[0].name, "echopath_mesh");
  EXPECT_EQ(meshes[0].mesh->triangles(), (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(meshes[0].mesh->vertices()[2], Vec3(1, 1, 0));
}

TEST(Obj, MakesAMeshOfEachGroupWithItsOwnVerticesOnly) {
  const std::vector<NamedMesh> meshes =
      read(kSquare + "g left\nf 1 2 4\ng right side\nf 2 3 4\ng left\nf 1 2 3\n" + "o box\nf 1 3 4\ng\nf 2 3 4\n");
  ASSERT_EQ(meshes.size(), 3u);
  EXPECT_EQ(meshes[0].name, "left");
  EXPECT_EQ(meshes[1].name, "right_side");
  EXPECT_EQ(meshes[2].name, "box");
  EXPECT_EQ(meshes[0].mesh->original_triangle(), (std::vector<uint32_t>{0, 2}));
  EXPECT_EQ(meshes[1].mesh->original_triangle(), (std::vector<uint32_t>{1}));
  EXPECT_EQ(meshes[1].mesh->vertices(), (std::vector<Vec3>{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(meshes[2].mesh->triangles().size(), 2u);
}

TEST(Obj, CountsNegativeIndicesBackFromTheFace) {
  const auto meshes = read("v 9 9 9\n" + kSquare + "f -4 -3 -2\nv 5 5 5\nf -5/1/1 -3//2 -2/7\n");
  EXPECT_EQ(meshes[0].mesh->vertices(), (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(meshes[0].mesh->triangles(), (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Obj, CutsPolygonsAndNumbersTheirFaces) {
  const auto meshes = read(kSquare + "v 0.5 0.25 0\nf 1 2 3 4\nf 1 2 5\n");
  EXPECT_EQ(meshes[0].mesh->original_triangle(), (std::vector<uint32_t>{0, 0, 1}));
}

TEST(Obj, CutsConcavePolygonsWithoutOverlap) {
  // An arrow head, an L and a comb, each begun at each of its corners: a fan would cover more than the polygon.
  // clang-format off
  const std::vector<std::pair<std::vector<Vec3>, double>> polygons = {
      {{{0, 0, 0}, {2, -1, 0}, {0.5, 0, 0}, {2, 1, 0}}, 0.5},
      {{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}, 4.0},
      {{{0, 0, 1}, {5, 0, 1}, {5, 2, 1}, {4, 2, 1}, {4, 1, 1}, {3, 1, 1}, {3, 2, 1}, {2, 2, 1}, {2, 1, 1}, {1, 1, 1},
        {1, 2, 1}, {0, 2, 1}}, 8.0}};
  // clang-format on
  for (const auto& [corners, area] : polygons) {
    for (size_t first = 0; first < corners.size(); ++first) {
      std::ostringstream content;
      for (const Vec3& p : corners) content << "v " << p.transpose() << "\n";
      content << "f";
      for (size_t i = 0; i < corners.size(); ++i) content << " " << (first + i) % corners.size() + 1;
      const MeshPtr mesh = read(content.str() + "\n")[0].mesh;
      EXPECT_NEAR(mesh->area(), area, kRounding);
      EXPECT_EQ(mesh->num_duplicated_vertices(), 0);
    }
  }
}

TEST(Obj, KeepsCoordinatesInDouble) {
  const auto meshes = read("v 5412345.678901 -0.1 1e-3\nv 5412346.678901 0 0\nv 5412345.678901 1 0\nf 1 2 3\n");
  const Vec3 read_back = meshes[0].mesh->vertices()[0];
  const double ulp = std::nextafter(5412345.678901, 1e9) - 5412345.678901;
  EXPECT_NEAR(read_back.x(), 5412345.678901, 2.0 * ulp);  // the parser does not round to the nearest
  EXPECT_NEAR(read_back.y(), -0.1, 1e-16);
}

TEST(Obj, ScalesByTheUnit) { EXPECT_EQ(read("v 0 0 0\nv 1000 0 0\nv 0 1000 0\nf 1 2 3\n", 1e-3)[0].mesh->area(), 0.5); }

TEST(Obj, PassesOverWhatItDoesNotNeed) {
  const auto meshes = read("# comment\r\nmtllib none.mtl\r\n  v 0 0 0 # origin\r\nvn 0 0 1\r\nvt 0 0\r\nv 1 0 \\\r\n 0\r\n"
                           "usemtl steel\r\ns off\r\nv 0 1 0 1.0\r\nl 1 2\r\n\r\nf 1/1/1 2/1/1 3/1/1 # face\r\n");
  EXPECT_EQ(meshes[0].mesh->vertices(), (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(Obj, LoadMeshJoinsAllGroupsInTheOrderOfTheFile) {
  const TemporaryFile file("joined.obj", kSquare + "g a\nf 1 2 3\ng b\nf 1 3 4\ng a\nf 1 2 4\n");
  const MeshPtr mesh = load_mesh(file.path());
  EXPECT_EQ(mesh->original_triangle(), (std::vector<uint32_t>{0, 1, 2}));
}

TEST(Obj, LeavesOutGroupsWithoutArea) {
  const auto meshes = read(kSquare + "g flat\nf 1 2 2\ng full\nf 1 2 3\n");
  ASSERT_EQ(meshes.size(), 1u);
  EXPECT_EQ(meshes[0].name, "full");
}

TEST(Obj, NamesTheLineOfAnError) {
  expect_refused(kSquare + "f 1 2 5\n", {"line 5", "vertex 5", "there are 4"});
  expect_refused(kSquare + "f 1 2 -5\n", {"line 5", "vertex -5"});
  expect_refused(kSquare + "f 0 1 2\n", {"line 5", "vertex 0"});
  expect_refused(kSquare + "f 1 2\n", {"line 5", "3 corners"});
  expect_refused(kSquare + "f 1 2 x\n", {"line 5", "not a number"});
  expect_refused("v 0 0\n" + kSquare, {"line 1", "3 numbers"});
  expect_refused("v 0 0 nan\n" + kSquare, {"line 1", "not a number"});
  expect_refused("v 0 \\\n0 0\nv 0 0 abc\n", {"line 3"});
}

TEST(Obj, RefusesFilesWithoutFaces) {
  expect_refused("", {"has no faces"});
  expect_refused(kSquare, {"has no faces"});
  expect_refused(kSquare + "f 1 1 2\n", {"no face with an area"});
}

TEST(Readers, RefuseWhatIsNoMeshFile) {
  expect_error<FileError>([] { load_mesh(testing::TempDir() + "echopath_missing.obj"); },
                          {"echopath_missing.obj", "opened"});
  expect_error<FileError>([] { load_mesh("mesh.stl"); }, {"mesh.stl", ".obj, .ply"});
  expect_error<std::invalid_argument>([] { load_mesh("mesh.obj", 0.0); }, {"unit", "positive"});
  expect_error<std::invalid_argument>([] { load_mesh("mesh.obj", std::nan("")); }, {"unit"});
}

}  // namespace
}  // namespace echopath::test_obj
