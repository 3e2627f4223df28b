#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <sstream>

#include "mesh_files.h"

namespace echopath::test_ply {
namespace {

using test::TemporaryFile;

enum class Format { kAscii, kLittle, kBig };
constexpr Format kFormats[] = {Format::kAscii, Format::kLittle, Format::kBig};

// Coordinates that float cannot hold.
const std::vector<Vec3> kVertices = {
    {5.4e6 + 0.123456789, -5.4e6, 0.1}, {5.4e6 + 1.0 / 3.0, 1e-300, 0.2}, {5.4e6, 3.0, -0.0}, {5.4e6 - 1, 2.0, 7e11 / 3.0}};

// Writes the values behind a header in one of the formats.
class Body {
 public:
  explicit Body(Format format) : format_(format) {}
  template <class Value>
  Body& put(Value value) {
    char text[64];
    if (format_ == Format::kAscii) {
      std::snprintf(text, sizeof text, std::is_floating_point_v<Value> ? "%.17g\n" : "%.0f ", static_cast<double>(value));
      content_ += text;
      return *this;
    }
    char bytes[sizeof(Value)];
    std::memcpy(bytes, &value, sizeof(Value));
    const bool big = std::endian::native == std::endian::big;
    if (big != (format_ == Format::kBig)) std::reverse(bytes, bytes + sizeof(Value));
    content_.append(bytes, sizeof(Value));
    return *this;
  }
  Body& row() {
    if (format_ == Format::kAscii) content_ += "\n";
    return *this;
  }
  const std::string& content() const { return content_; }

 private:
  Format format_;
  std::string content_;
};

std::string first_lines(Format format) {
  const char* names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
  return std::string("ply\nformat ") + names[static_cast<int>(format)] + " 1.0\ncomment made by a test\n";
}

MeshPtr read(const std::string& content) { return test::read_meshes("mesh.ply", content).at(0).mesh; }

std::string two_triangles(Format format) {
  Body body(format);
  for (const Vec3& p : kVertices) body.put(p.x()).put(p.y()).put(p.z());
  body.put(uint8_t{3}).put(int32_t{0}).put(int32_t{1}).put(int32_t{2}).row();
  body.put(uint8_t{3}).put(int32_t{0}).put(int32_t{2}).put(int32_t{3}).row();
  return first_lines(format) +
         "element vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
         "element face 2\nproperty list uchar int vertex_indices\nend_header\n" +
         body.content();
}

TEST(Ply, ReadsDoublesBitForBitInEachFormat) {
  for (const Format format : kFormats) {
    const MeshPtr mesh = read(two_triangles(format));
    ASSERT_EQ(mesh->vertices().size(), kVertices.size());
    EXPECT_EQ(std::memcmp(mesh->vertices().data(), kVertices.data(), sizeof(Vec3) * kVertices.size()), 0);
    EXPECT_EQ(mesh->triangles(), (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  }
}

// Properties in an order of their own, extra ones, lists between them, elements before and behind.
TEST(Ply, SkipsWhatItDoesNotNeedInEachFormat) {
  for (const Format format : kFormats) {
    Body body(format);
    body.put(int16_t{-3}).put(uint16_t{2}).put(1.5f).put(2.5f);
    for (int i = 0; i < 4; ++i) {
      const float x = i == 1 || i == 2 ? 1.0f : 0.0f, y = i >= 2 ? 1.0f : 0.0f;
      body.put(uint8_t{255}).put(0.25f).put(uint8_t{1}).put(int8_t{-1}).put(y).put(x);
    }
    body.put(uint8_t{7}).put(uint8_t{4}).put(uint32_t{0}).put(uint32_t{1}).put(uint32_t{2}).put(uint32_t{3}).put(0.5);
    body.put(int32_t{42});
    const MeshPtr mesh = read(first_lines(format) +
                              "obj_info none\nelement camera 1\nproperty short id\nproperty list ushort float32 view\n"
                              "element vertex 4\nproperty uchar red\nproperty float z\nproperty list uint8 int8 tags\n"
                              "property float y\nproperty float x\n"
                              "element face 1\nproperty uint8 flags\nproperty list uchar uint vertex_index\n"
                              "property float64 quality\nelement last 1\nproperty int value\nend_header\n" +
                              body.content());
    EXPECT_EQ(mesh->vertices(), (std::vector<Vec3>{{0, 0, 0.25}, {1, 0, 0.25}, {1, 1, 0.25}, {0, 1, 0.25}}));
    EXPECT_EQ(mesh->triangles().size(), 2u);
    EXPECT_EQ(mesh->original_triangle(), (std::vector<uint32_t>{0, 0}));
    EXPECT_EQ(mesh->area(), 1.0);
  }
}

// As scans of Stanford have them: -1 ends a strip, and every second triangle of one is turned.
TEST(Ply, ReadsTriangleStripsInEachFormat) {
  for (const Format format : kFormats) {
    Body body(format);
    for (const Vec3& p : kVertices) body.put(p.x()).put(p.y()).put(p.z());
    body.put(int32_t{9});
    for (const int32_t index : {0, 1, 2, 3, -1, 3, 1, 0, -1}) body.put(index);
    const MeshPtr mesh = read(first_lines(format) +
                              "element vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
                              "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
                              body.content());
    EXPECT_EQ(mesh->triangles(), (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}, {3, 1, 0}}));
  }
}

// Rows of text may hold more than the header says, and several elements may share a line.
TEST(Ply, ElementsOfTextAreReadByLinesWhereThereAreEnough) {
  const std::string head = first_lines(Format::kAscii) +
                           "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                           "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string faces[] = {"3 0 1 2 9 1 1\n3 2 1 0 7\n", "3 0 1 2\n3 2 1 0", "3 0\n1 2 5 5\n3 2 1 0\n"};
  for (const std::string& rows : faces) {
    const MeshPtr mesh = read(head + "0 0 0 8\n1 0 0 8 8\n1 1 0 3 0 1 2\n" + rows);
    EXPECT_EQ(mesh->triangles().size(), 2u) << rows;
    EXPECT_EQ(mesh->vertices()[2], Vec3(1, 1, 0)) << rows;
  }
  EXPECT_EQ(read(head + "0 0 0 1 0 0 1 1 0 3 0 1 2 3 2 1 0\n")->triangles().size(), 2u);
}

TEST(Ply, NormalsOfItsVerticesAreThoseOfTheCorners) {
  std::string text = two_triangles(Format::kAscii);
  text.replace(text.find("property double x"), 0, "property float nz\nproperty float nx\nproperty float ny\n");
  std::istringstream plain(two_triangles(Format::kAscii));
  EXPECT_TRUE(read_surfaces(plain, "a.ply").surfaces[0].normals.empty());
  const std::string body = "0 2 0 0 0 0\n0 0 3 1 0 0\n1 0 0 1 1 0\n0 0 0 0 1 0\n3 0 1 2\n3 0 2 3\n";
  std::istringstream stream(text.substr(0, text.find("end_header")) + "end_header\n" + body);
  const Surfaces::Surface surface = read_surfaces(stream, "a.ply").surfaces[0];
  // nz stands first; the last vertex has no direction, and takes that of the facet
  const std::vector<Vec3> wanted = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, 1}, {0, 0, 1}};
  EXPECT_EQ(surface.normals, wanted);
}

TEST(Ply, IsNamedByItsStemAndScaledByTheUnit) {
  const TemporaryFile file("part.PLY", two_triangles(Format::kBig));
  const std::vector<NamedMesh> meshes = load_meshes(file.path(), 0.5);
  ASSERT_EQ(meshes.size(), 1u);
  EXPECT_EQ(meshes[0].name, "echopath_part");
  EXPECT_EQ(meshes[0].mesh->vertices()[2].x(), 2.7e6);
}

void expect_refused(const std::string& content, std::initializer_list<std::string> pieces) {
  test::expect_refused("broken.ply", content, pieces);
}

// Wherever a file is cut there is an error, and never a mesh. ASCII may lose its last line break.
TEST(Ply, RefusesAFileCutAnywhere) {
  for (const Format format : kFormats) {
    std::string whole = two_triangles(format);
    if (format == Format::kAscii) whole.erase(whole.find_last_not_of(" \n") + 1);
    for (size_t length = 0; length < whole.size(); ++length) {
      const TemporaryFile file("cut.ply", whole.substr(0, length));
      EXPECT_THROW(load_mesh(file.path()), FileError) << length << " of " << whole.size();
    }
  }
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

TEST(Ply, NamesTheLineOfAnErrorInTheHeader) {
  const std::string good = two_triangles(Format::kAscii);
  expect_refused(replaced(good, "ply\n", "plz\n"), {"line 1", "'ply'"});
  expect_refused(replaced(good, "ascii 1.0", "ascii 2.0"), {"line 2", "version 1.0"});
  expect_refused(replaced(good, "ascii", "binary"), {"line 2", "unknown format"});
  expect_refused(replaced(good, "element vertex 4", "element vertex -4"), {"line 4", "whole number"});
  expect_refused(replaced(good, "element vertex 4", "element vertex"), {"line 4", "count"});
  expect_refused(replaced(good, "double x", "quad x"), {"line 5", "unknown type 'quad'"});
  expect_refused(replaced(good, "property double x", "properly double x"), {"line 5", "properly"});
  expect_refused(replaced(good, "element vertex 4\n", ""), {"line 4", "before the first element"});
  expect_refused(replaced(good, "format ascii 1.0\n", ""), {"no line 'format'"});
}

TEST(Ply, RefusesVerticesThatAreNotFinite) {
  const double nan = std::nan("");
  for (const Format format : kFormats) {
    Body body(format);
    for (const double y : {0.0, 1.0, nan}) body.put(y).put(1.0).put(y * y);
    body.put(uint8_t{3}).put(int32_t{0}).put(int32_t{1}).put(int32_t{2});
    expect_refused(first_lines(format) +
                       "element vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
                       "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
                       body.content(),
                   {"vertex 2", "coordinate"});
  }
  expect_refused(replaced(two_triangles(Format::kAscii), "-5400000", "1e999"), {"line 13", "vertex 0", "out of range"});
}

TEST(Ply, RefusesContentThatDoesNotFitItsHeader) {
  const std::string good = two_triangles(Format::kAscii);
  expect_refused(replaced(good, "double z", "double w"), {"x, y and z"});
  expect_refused(replaced(good, "vertex_indices", "corners"), {"vertex_indices"});
  expect_refused(replaced(good, "3 0 1 2", "3 0 1 4"), {"line 23", "face 0", "vertex 4", "there are 4"});
  expect_refused(replaced(good, "3 0 1 2", "3 0 1 -1"), {"face 0", "vertex -1"});
  expect_refused(replaced(good, "3 0 1 2", "2 0 1"), {"face 0", "fewer than 3"});
  expect_refused(replaced(good, "3 0 1 2", "-3 0 1 2"), {"length"});
  expect_refused(replaced(good, "3 0 1 2", "3 0 1x 2"), {"line 23", "1x"});
  expect_refused(replaced(good, "element face 2", "element face 3"), {"ends too early"});
  expect_refused(replaced(good, "element vertex 4", "element vertex 9000000000000000000"), {"line 25", "ends too early"});
  expect_refused(replaced(two_triangles(Format::kLittle), "element vertex 4", "element vertex 9000000000000000000"),
                 {"ends too early"});
  expect_refused(replaced(good, "element face 2", "element none 2"), {"no faces"});
}

}  // namespace
}  // namespace echopath::test_ply
