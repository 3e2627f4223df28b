#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <iterator>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/base/text/streamed.h"
#include "echopath/scene/readers/ply_header.h"
#include "echopath/scene/readers/soup.h"

namespace echopath {
namespace {

// Reads the values behind the header one after the other. A double holds each type of the format exactly.
class PlyValues {
 public:
  PlyValues(std::string body, const PlyHeader& header, std::string path)
      : body_(std::move(body)), format_(header.format), path_(std::move(path)), line_(header.num_lines + 1) {
    if (format_ != PlyFormat::kAscii) return;
    double num_rows = 0.0;  // which overflows no whole number, whatever a header says
    for (const PlyElement& element : header.elements) num_rows += static_cast<double>(element.count);
    has_rows_ = static_cast<double>(std::count(body_.begin(), body_.end(), '\n')) >= num_rows - 1.0;
  }

  double next(PlyType type) {
    if (format_ == PlyFormat::kAscii) return next_word();
    switch (type) {
      case PlyType::kInt8: return next_binary<int8_t>();
      case PlyType::kUint8: return next_binary<uint8_t>();
      case PlyType::kInt16: return next_binary<int16_t>();
      case PlyType::kUint16: return next_binary<uint16_t>();
      case PlyType::kInt32: return next_binary<int32_t>();
      case PlyType::kUint32: return next_binary<uint32_t>();
      case PlyType::kFloat32: return next_binary<float>();
      case PlyType::kFloat64: break;
    }
    return next_binary<double>();
  }

  // Passes over what a line of text has beyond the properties of its element, as MeshLab writes beside wedges. Where there
  // are fewer lines than elements, several elements share a line.
  void end_row() {
    if (has_rows_) at_ = std::min(body_.find_first_of("\r\n", at_), body_.size());
  }

  size_t bytes_left() const { return body_.size() - at_; }

  [[noreturn]] void refuse(const std::string& what) const {
    const std::string place = format_ == PlyFormat::kAscii ? ", line " + std::to_string(line_) : "";
    throw FileError(path_ + place + ": " + what);
  }

 private:
  template <class Value>
  double next_binary() {
    if (bytes_left() < sizeof(Value)) refuse("the file ends too early");
    char bytes[sizeof(Value)];
    std::memcpy(bytes, body_.data() + at_, sizeof(Value));
    at_ += sizeof(Value);
    const bool swap = (format_ == PlyFormat::kBigEndian) != (std::endian::native == std::endian::big);
    if (swap) std::reverse(bytes, bytes + sizeof(Value));
    Value value;
    std::memcpy(&value, bytes, sizeof(Value));
    return static_cast<double>(value);
  }

  double next_word() {
    const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
    for (; at_ < body_.size() && is_blank(body_[at_]); ++at_) line_ += body_[at_] == '\n';
    if (at_ == body_.size()) refuse("the file ends too early");
    const char* const begin = body_.data() + at_ + (body_[at_] == '+' ? 1 : 0);
    const char* const end = body_.data() + body_.size();
    double value = 0.0;
    const auto [stop, error] = std::from_chars(begin, end, value);
    const bool overflow = error == std::errc::result_out_of_range;
    if ((error != std::errc() && !overflow) || (stop != end && !is_blank(*stop))) {
      const char* const word = body_.data() + at_;
      refuse("not a number: '" + std::string(word, std::find_if(word, end, is_blank)) + "'");
    }
    at_ = static_cast<size_t>(stop - body_.data());
    return overflow ? std::nan("") : value;
  }

  std::string body_;
  PlyFormat format_;
  std::string path_;
  int64_t line_;
  size_t at_ = 0;
  bool has_rows_ = false;
};

// Reads one list or value; `out` receives its items.
void read_property(PlyValues& values, const PlyProperty& property, std::vector<double>& out) {
  out.clear();
  const double count = property.is_list ? values.next(property.count_type) : 1.0;
  if (!(count >= 0.0) || count != std::floor(count)) values.refuse("a list's length must be a whole number from 0");
  if (count > static_cast<double>(values.bytes_left())) values.refuse("the file ends too early");
  const auto size = static_cast<int64_t>(count);
  for (int64_t i = 0; i < size; ++i) out.push_back(values.next(property.type));
}

void skip(PlyValues& values, const PlyElement& element) {
  if (element.properties.empty()) return;
  std::vector<double> items;
  for (int64_t i = 0; i < element.count; ++i) {
    for (const PlyProperty& property : element.properties) read_property(values, property, items);
    values.end_row();
  }
}

void read_vertices(PlyValues& values, const PlyElement& element, Soup& soup) {
  const int axes[3] = {element.find({"x"}), element.find({"y"}), element.find({"z"})};
  if (*std::min_element(axes, axes + 3) < 0) values.refuse("element 'vertex' needs the properties x, y and z");
  for (const int axis : axes) {
    if (element.properties[axis].is_list) values.refuse("x, y and z must not be lists");
  }
  const int normal_axes[3] = {element.find({"nx"}), element.find({"ny"}), element.find({"nz"})};
  const bool has_normals = *std::min_element(normal_axes, normal_axes + 3) >= 0;
  soup.vertices.reserve(std::min(static_cast<size_t>(element.count), values.bytes_left()));
  std::vector<double> items, row(element.properties.size());
  for (int64_t i = 0; i < element.count; ++i) {
    for (size_t p = 0; p < row.size(); ++p) {
      read_property(values, element.properties[p], items);
      row[p] = items.empty() ? 0.0 : items[0];
    }
    values.end_row();
    const auto vector_of = [&](const int (&columns)[3]) { return Vec3(row[columns[0]], row[columns[1]], row[columns[2]]); };
    const Vec3 point = vector_of(axes);
    if (!point.allFinite()) values.refuse("vertex " + std::to_string(i) + ": a coordinate is out of range or not a number");
    soup.vertices.push_back(point);
    if (has_normals) soup.normals.push_back(vector_of(normal_axes));
  }
}

// Adds a face; a vertex's normal is that of each face's corner there.
void add_face(const PlyValues& values, const std::vector<double>& items, Soup& soup) {
  const std::string face = "face " + std::to_string(soup.num_faces());
  if (items.size() < 3) values.refuse(face + " has fewer than 3 corners");
  std::vector<uint32_t> corners;
  for (const double item : items) {
    const bool exists = item >= 0.0 && item < static_cast<double>(soup.vertices.size()) && item == std::floor(item);
    if (!exists) {
      values.refuse(streamed(face, ": vertex ", item, " does not exist, there are ", soup.vertices.size()));
    }
    corners.push_back(static_cast<uint32_t>(item));
  }
  soup.add_polygon(corners, 0, soup.normals.empty() ? std::vector<uint32_t>{} : corners);
}

// Adds the triangles of strips, of which -1 ends one; every second triangle is turned, so that all have one front.
void add_strips(const PlyValues& values, const std::vector<double>& items, Soup& soup) {
  constexpr double kEnd = -1.0;
  size_t begin = 0;
  for (size_t i = 0; i < items.size(); ++i) {
    if (items[i] == kEnd) begin = i + 1;
    if (i < begin + 2) continue;
    const bool is_turned = (i - begin) % 2 == 1;
    add_face(values, {items[i - 2], items[is_turned ? i : i - 1], items[is_turned ? i - 1 : i]}, soup);
  }
}

// Reads the lists of vertices of an element; `add` adds what one of them stands for.
void read_faces(PlyValues& values, const PlyElement& element, Soup& soup, decltype(add_face)& add) {
  const int list = element.find({"vertex_indices", "vertex_index"});
  if (list < 0 || !element.properties[list].is_list) {
    values.refuse("element '" + element.name + "' needs the list property vertex_indices");
  }
  std::vector<double> items, corners;
  for (int64_t i = 0; i < element.count; ++i) {
    for (size_t p = 0; p < element.properties.size(); ++p) {
      read_property(values, element.properties[p], p == static_cast<size_t>(list) ? corners : items);
    }
    values.end_row();
    add(values, corners, soup);
  }
}

}  // namespace

Soup read_ply(std::istream& file, const std::string& name) {
  const PlyHeader header = read_ply_header(file, name);
  std::string body((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  PlyValues values(std::move(body), header, name);
  Soup soup;
  soup.group_names.emplace_back();
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") {
      if (!soup.vertices.empty()) values.refuse("element 'vertex' comes twice");
      read_vertices(values, element, soup);
    } else if (element.name == "face") {
      read_faces(values, element, soup, add_face);
    } else if (element.name == "tristrips") {
      read_faces(values, element, soup, add_strips);
    } else {
      skip(values, element);
    }
  }
  return soup;
}

}  // namespace echopath
