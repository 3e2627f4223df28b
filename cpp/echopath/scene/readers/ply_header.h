#pragma once
// Reads the header of a PLY file (Turk, "The PLY polygon file format", 1994). Internal to the module.
#include <cstdint>
#include <istream>
#include <string>
#include <vector>

namespace echopath {

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };
enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;  // of the value, or of the items of a list
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;  // of a list's length
};

struct PlyElement {
  std::string name;
  int64_t count = 0;
  std::vector<PlyProperty> properties;

  // Returns the index of the first property with one of the names, -1 where there is none.
  int find(const std::vector<std::string>& names) const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  int64_t num_lines = 0;
};

// Reads up to and including the line end_header. Raises FileError naming `path` and the line.
PlyHeader read_ply_header(std::istream& stream, const std::string& path);

}  // namespace echopath
