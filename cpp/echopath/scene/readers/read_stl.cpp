#include <algorithm>
#include <bit>
#include <iterator>
#include <string_view>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/scene/readers/merged_points.h"
#include "echopath/scene/readers/obj_words.h"
#include "echopath/scene/readers/soup.h"
#include "echopath/scene/readers/text_lines.h"

namespace echopath {
namespace {

constexpr size_t kStlHeader = 80;                            // bytes of any content before the number of triangles
constexpr size_t kStlFirst = kStlHeader + sizeof(uint32_t);  // place of the first triangle
constexpr size_t kStlRecord = 50;                            // normal and three corners in float, two bytes of anything
constexpr size_t kStlCorners = 3 * sizeof(float);            // place of the corners in a record

uint32_t little_endian(const char* at) {
  uint32_t value = 0;
  for (size_t byte = 0; byte < sizeof value; ++byte) value |= uint32_t{static_cast<uint8_t>(at[byte])} << (8 * byte);
  return value;
}

// Files that begin with "solid" may be binary all the same; the number of triangles tells, which fits the size exactly.
bool is_stl_text(const std::string& bytes) {
  if (bytes.size() >= kStlFirst && bytes.size() == kStlFirst + kStlRecord * little_endian(bytes.data() + kStlHeader)) {
    return false;
  }
  std::string_view first = bytes;
  first.remove_prefix(std::min(first.find_first_not_of(" \t\r\n"), first.size()));
  first = first.substr(0, first.find_first_of("\r\n"));
  return is_word(take_word(first), "solid") && bytes.find('\0') == std::string::npos;
}

Soup read_binary_stl(const std::string& bytes, const std::string& name) {
  if (bytes.size() < kStlFirst)
    throw FileError(name + ": the file ends too early, a binary STL file has a head of 84 bytes");
  const uint64_t count = little_endian(bytes.data() + kStlHeader);
  const uint64_t held = (bytes.size() - kStlFirst) / kStlRecord;
  if (count > held) {
    throw FileError(name + ": the file ends too early, it should have " + std::to_string(count) + " triangles and has " +
                    std::to_string(held));
  }
  Soup soup;
  soup.group_names.emplace_back();
  MergedPoints points(soup.vertices);
  std::vector<uint32_t> corners(3);
  for (uint64_t t = 0; t < count; ++t) {
    const char* const record = bytes.data() + kStlFirst + kStlRecord * t + kStlCorners;
    for (size_t i = 0; i < 3; ++i) {
      Vec3 point;
      for (size_t axis = 0; axis < 3; ++axis) {
        const float value = std::bit_cast<float>(little_endian(record + sizeof(float) * (3 * i + axis)));
        point[static_cast<Eigen::Index>(axis)] = static_cast<double>(value);
      }
      if (!point.allFinite()) throw FileError(name + ": triangle " + std::to_string(t) + ": a coordinate is not a number");
      corners[i] = points.index_of(point);
    }
    soup.add_polygon(corners, 0);
  }
  return soup;
}

// Reads the lines of a text: solid, facet normal, outer loop, vertex, endloop, endfacet, endsolid.
class StlText {
 public:
  StlText(const std::string& bytes, const std::string& name) : lines_(bytes, name), points_(soup.vertices) {}

  void read() {
    while (lines_.next()) read_line(lines_.text());
    if (in_loop_) lines_.refuse("the file ends within a facet");
    if (in_solid_) lines_.refuse("the file ends too early, before the endsolid of a solid");
  }

  Soup soup;

 private:
  void read_line(std::string_view rest) {
    const std::string_view keyword = take_word(rest);
    if (is_word(keyword, "vertex")) add_corner(rest);
    else if (is_word(keyword, "outer")) begin_loop();
    else if (is_word(keyword, "endloop")) end_loop();
    else if (is_word(keyword, "solid")) begin_solid(rest);
    else if (is_word(keyword, "endsolid")) in_solid_ = false;
    else if (!is_word(keyword, "facet") && !is_word(keyword, "endfacet")) {
      lines_.refuse("not a line of an STL text: '" + std::string(lines_.text().substr(0, 60)) + "'");
    }
  }

  void begin_solid(std::string_view title) {
    in_solid_ = true;
    title = trimmed(title);
    const std::string solid = is_name(title) ? std::string(title) : "";
    for (group_ = 0; group_ < soup.group_names.size(); ++group_) {
      if (soup.group_names[group_] == solid) return;
    }
    soup.group_names.push_back(solid);
  }

  void begin_loop() {
    if (in_loop_) lines_.refuse("a loop begins within a loop");
    in_loop_ = true;
    corners_.clear();
  }

  void add_corner(std::string_view rest) {
    if (!in_loop_) lines_.refuse("a vertex must stand within an outer loop");
    corners_.push_back(points_.index_of(lines_.point(rest)));
  }

  void end_loop() {
    if (!in_loop_) lines_.refuse("endloop without an outer loop");
    if (corners_.size() < 3) lines_.refuse("a facet needs 3 vertices, it has " + std::to_string(corners_.size()));
    if (soup.group_names.empty()) soup.group_names.emplace_back();
    soup.add_polygon(corners_, static_cast<uint32_t>(group_));
    in_loop_ = false;
  }

  TextLines lines_;
  MergedPoints points_;
  std::vector<uint32_t> corners_;
  size_t group_ = 0;
  bool in_loop_ = false, in_solid_ = false;
};

}  // namespace

Soup read_stl(std::istream& file, const std::string& name) {
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (!is_stl_text(bytes)) return read_binary_stl(bytes, name);
  StlText text(bytes, name);
  text.read();
  return std::move(text.soup);
}

}  // namespace echopath
