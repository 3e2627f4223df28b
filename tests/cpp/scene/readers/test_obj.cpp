#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "mesh_files.h"

namespace echopath::test_obj {
namespace {

using test::expect_error;
using test::TemporaryFile;

constexpr double kRounding = 1e-12;

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::vector<NamedMesh> read(const std::string& content, double unit = 1.0) {
  return test::read_meshes("mesh.obj", content, unit);
}

void expect_refused(const std::string& content, std::initializer_list<std::string> pieces) {
  test::expect_refused("broken.obj", content, pieces);
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

TEST(Obj, KeepsGroupsOfOneNameApartWhereTheyBelongToObjects) {
  const std::vector<NamedMesh> meshes =
      read(kSquare + "o car1\ng wheel\nf 1 2 3\no car2\ng wheel\nf 1 3 4\ng car2\nf 1 2 4\n" + "o car1\ng wheel\nf 2 3 4\n");
  std::vector<std::string> names;
  for (const NamedMesh& one : meshes) names.push_back(one.name);
  EXPECT_EQ(names, (std::vector<std::string>{"car1/wheel", "car2/wheel", "car2/rest"}));
  EXPECT_EQ(meshes[0].mesh->original_triangle(), (std::vector<uint32_t>{0, 3}));
}

TEST(Obj, WhatBelongsToNoGroupHasANameOfItsOwn) {
  std::vector<std::string> names;
  for (const NamedMesh& one : read(kSquare + "o car\nf 1 2 3\ng rest\nf 1 2 4\n")) names.push_back(one.name);
  EXPECT_EQ(names, (std::vector<std::string>{"car/rest_2", "car/rest"}));
}

std::vector<Vec3> normals_of(const std::string& content) {
  std::istringstream stream(content);
  return read_surfaces(stream, "mesh.obj").surfaces[0].normals;
}

TEST(Obj, CornersHaveTheNormalsOfTheFile) {
  const std::string given = kSquare + "vn 0 0 2\nvn 0 1 1\n";
  const double half = std::sqrt(0.5);
  const std::vector<Vec3> normals = normals_of(given + "f 1//1 2//2 3//-2\nf 1//1 2//9 3//1\nf 1 3 4\n");
  ASSERT_EQ(normals.size(), 9u);
  EXPECT_NEAR((normals[1] - Vec3(0, half, half)).norm(), 0.0, kRounding);
  for (const size_t corner : {0, 2, 3, 4, 5, 6, 7, 8}) {
    EXPECT_NEAR((normals[corner] - Vec3(0, 0, 1)).norm(), 0.0, kRounding);
  }
  EXPECT_TRUE(normals_of(given + "f 1 2 3\ns off\nf 1 3 4\n").empty());
}

// Two squares that meet at a right angle along x = 1.
TEST(Obj, SmoothingGroupsHaveTheMeanNormalOfTheirFaces) {
  const std::string bent = kSquare + "v 1 0 1\nv 1 1 1\n", faces = "f 1 2 3 4\nf 2 5 6 3\n";
  const std::vector<Vec3> together = normals_of(bent + "s 1\n" + faces);
  const std::vector<Vec3> apart = normals_of(bent + "s 1\nf 1 2 3 4\ns 2\nf 2 5 6 3\n");
  ASSERT_EQ(together.size(), 12u);
  EXPECT_NEAR((together[0] - Vec3(0, 0, 1)).norm(), 0.0, kRounding);
  EXPECT_NEAR((together[2] - Vec3(-1, 0, 2).normalized()).norm(), 0.0, kRounding);  // corner 3: two triangles and one
  for (size_t i = 0; i < 6; ++i) EXPECT_NEAR((apart[i] - Vec3(0, 0, 1)).norm(), 0.0, kRounding);
  for (size_t i = 6; i < 12; ++i) EXPECT_NEAR((apart[i] - Vec3(-1, 0, 0)).norm(), 0.0, kRounding);
}

TEST(Frames, TakeTheirFacesFromTheFirstFileAndItsPlacesFromEach) {
  const std::string face = "f 1 2 3 4\n";  // convex in the first, with a dent at its second corner in the second
  const TemporaryFile first("frame1.obj", kSquare + face);
  const TemporaryFile second("frame2.obj", "v 0 0 0\nv 0.375 0.5 0\nv 1 1 0\nv 0 1 0\n" + face);
  const SurfaceFrames frames = load_frames({first.path(), second.path()}, 2.0);
  ASSERT_EQ(frames.surfaces.size(), 1u);
  EXPECT_EQ(frames.surfaces[0].triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_NEAR((frames.vertices[0][1][1] - Vec3(0.75, 1, 0)).norm(), 0.0, kRounding);
  const TemporaryFile other("frame3.obj", kSquare + "f 1 2 3\nf 1 3 4\n");
  expect_error<FileError>([&] { load_frames({first.path(), other.path()}); }, {"frame3.obj", "of the first frame, "});
  expect_error<std::invalid_argument>([] { load_frames({}); }, {"paths", "at least one"});
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

TEST(Obj, ReadsPastAByteOrderMark) {
  const auto meshes = read("\xEF\xBB\xBF" + kSquare + "f 1 2 3 4\n");
  EXPECT_EQ(meshes[0].mesh->area(), 1.0);
}

TEST(Obj, NamesAnEncodingThatItDoesNotRead) {
  for (const std::string mark : {"\xFF\xFE", "\xFE\xFF"}) {
    expect_refused(mark + kSquare + "f 1 2 3\n", {"line 1", "must be UTF-8 or Latin-1 text, is UTF-16"});
  }
}

TEST(Obj, ReadsLinesThatEndAsOnAnySystem) {
  const auto meshes = read("# old\rv 0 0 0\rv 1 0 0\r\nv 0 1 0\nf 1 2 3\r");
  EXPECT_EQ(meshes[0].mesh->area(), 0.5);
  expect_refused("# old\rv 0 0\rv 1 0 0\r", {"line 2", "3 numbers"});
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
  expect_refused("v\n" + kSquare, {"line 1", "3 numbers"});
  expect_refused(kSquare + "f\n", {"line 5", "3 corners"});
}

// Its parser would read each of these as another number.
TEST(Obj, RefusesWordsThatItsParserMisreads) {
  expect_refused("v 1-2 0 0\n", {"line 1", "not a number: '1-2'"});
  expect_refused("v 1 . 0\n", {"not a number: '.'"});
  expect_refused("v 1e9999999999 0 0\n", {"not a number"});
  expect_refused("v 0." + std::string(400, '0') + "1e400 0 0\n", {"hundreds of digits"});
  expect_refused(kSquare + "f 1 2 1-2\n", {"line 5", "'1-2'"});
  expect_refused(kSquare + "f 4294967297 2 3\n", {"line 5", "'4294967297'"});
  expect_refused("v 1e71 0 0\n" + kSquare + "f 1 2 3\n", {"beyond 1e70 m"});
}

TEST(Obj, TakesColoursThatAreNoNumbers) {
  const std::string coloured = "v 0 0 0 nan NaN -nan\nv 1 0 0 0.5 1 nan\nv 0 1 0 -inf 0 Infinity\nf 1 2 3\n";
  EXPECT_EQ(read(coloured)[0].mesh->vertices(), read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")[0].mesh->vertices());
  expect_refused("v 0 0 0 1 1 x4\n", {"line 1", "not a number: 'x4'"});
  expect_refused("v 0 nan 0\n", {"line 1", "not a number: 'nan'"});
}

TEST(Obj, RefusesNamesThatAreNoText) {
  const std::string face = kSquare + "f 1 2 3\n";
  expect_refused("g a" + std::string(1, '\0') + "b\n" + face, {"line 1", "must not hold NUL"});
  expect_refused("g \xDF" + std::string(1, '\0') + "\n" + face, {"line 1", "must not hold NUL"});
}

// The bytes of Latin-1 are the first 256 code points of Unicode, of which UTF-8 makes two bytes from 128 on.
TEST(Obj, TakesNamesThatAreNoUtf8ForLatin1) {
  const std::string face = kSquare + "f 1 2 3\n";
  EXPECT_EQ(read("o Stra\xDF"
                 "e\n" +
                 face)[0]
                .name,
            "Stra\xC3\x9F"
            "e");
  EXPECT_EQ(read("o \xE4\xFF\x80"
                 "A\n" +
                 face)[0]
                .name,
            "\xC3\xA4\xC3\xBF\xC2\x80"
            "A");
  for (const char* name : {"\xC0\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE2\x82", "\x80"}) {
    EXPECT_EQ(read(std::string("g ") + name + "\n" + face)[0].name.size(), 2 * std::string_view(name).size());
  }
  const std::string euro_and_car = "\xE2\x82\xAC\xF0\x9F\x9A\x97";
  EXPECT_EQ(read("# Stra\xDF\ng " + euro_and_car + "\n" + face)[0].name, euro_and_car);
}

TEST(Obj, RefusesFilesWithoutFaces) {
  expect_refused("", {"has no faces"});
  expect_refused(kSquare, {"has no faces"});
  expect_refused(kSquare + "f 1 1 2\n", {"no face with an area"});
}

TEST(Readers, RefuseWhatIsNoMeshFile) {
  expect_error<FileError>([] { load_mesh(testing::TempDir() + "echopath_missing.obj"); },
                          {"echopath_missing.obj", "opened"});
  expect_error<FileError>([] { load_mesh("mesh.dae"); }, {"mesh.dae", ".obj, .ply, .stl, .off"});
  expect_error<std::invalid_argument>([] { load_mesh("mesh.obj", 0.0); }, {"unit", "positive"});
  expect_error<std::invalid_argument>([] { load_mesh("mesh.obj", std::nan("")); }, {"unit"});
}

TEST(Obj, SurfacesAreGroupsByMaterialAndMeshesAreGroups) {
  const TemporaryFile file("house.obj", "mtllib house.mtl more.mtl\n" + kSquare +
                                            "f 1 2 3\ng wall\nusemtl brick\nf 1 2 3\nusemtl  glass pane \nf 1 3 4\ng door\n"
                                            "f 1 2 4\ng wall\nusemtl brick\nf 2 3 4\n");
  const Surfaces found = load_surfaces(file.path());
  std::vector<std::array<std::string, 2>> names;
  for (const Surfaces::Surface& one : found.surfaces) names.push_back({one.name, one.material});
  EXPECT_EQ(names, (std::vector<std::array<std::string, 2>>{
                       {"echopath_house", ""}, {"wall", "brick"}, {"wall", "glass pane"}, {"door", "glass pane"}}));
  EXPECT_EQ(found.surfaces[1].face, (std::vector<uint32_t>{1, 4}));
  EXPECT_TRUE(found.surfaces[1].normals.empty());
  EXPECT_EQ(found.material_files, (std::vector<std::string>{"house.mtl more.mtl"}));
  ASSERT_EQ(load_meshes(file.path()).size(), 3u);
  EXPECT_EQ(load_meshes(file.path())[1].mesh->triangles().size(), 3u);
}

TEST(Obj, NamesOfMaterialsAreText) {
  expect_refused(kSquare + "usemtl a" + std::string(1, '\0') + "\nf 1 2 3\n", {"line 5", "must not hold NUL"});
}

}  // namespace
}  // namespace echopath::test_obj
