#include "echopath/scene/readers/readers.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/scene/readers/soup.h"

namespace echopath {
namespace {

struct Reader {
  std::string_view extension;
  Soup (*read)(const std::string& path);
};
constexpr Reader kReaders[] = {{".obj", read_obj}, {".ply", read_ply}};

const Reader& reader_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string(), known;
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const Reader& reader : kReaders) {
    if (reader.extension == extension) return reader;
    known.append(known.empty() ? "" : ", ").append(reader.extension);
  }
  throw FileError(path + ": unknown mesh format '" + extension + "', known are " + known);
}

Soup read(const std::string& path, double unit) {
  require(std::isfinite(unit) && unit > 0.0, "unit", "must be positive, in metres per file unit", unit);
  const Reader& reader = reader_of(path);
  if (std::filesystem::is_directory(path)) throw FileError(path + ": is a directory");
  Soup soup = reader.read(path);
  if (soup.triangles.empty()) throw FileError(path + ": has no faces");
  for (Vec3& vertex : soup.vertices) vertex *= unit;
  return soup;
}

// Holds the triangles of one group with the vertices they use, in the order of the file.
struct Part {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<uint32_t> face;
};

// `number` [V] is scratch for the vertices' numbers in the part.
Part part_of(const Soup& soup, const std::vector<uint32_t>& members, std::vector<uint32_t>& number) {
  std::vector<uint32_t> used;
  for (const uint32_t t : members) used.insert(used.end(), soup.triangles[t].begin(), soup.triangles[t].end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  Part part;
  for (const uint32_t vertex : used) {
    number[vertex] = static_cast<uint32_t>(part.vertices.size());
    part.vertices.push_back(soup.vertices[vertex]);
  }
  for (const uint32_t t : members) {
    const Triangle& corners = soup.triangles[t];
    part.triangles.push_back({number[corners[0]], number[corners[1]], number[corners[2]]});
    part.face.push_back(soup.face[t]);
  }
  return part;
}

// Returns null where no triangle has an area.
MeshPtr mesh_of(Part part) {
  try {
    return std::make_shared<const Mesh>(std::move(part.vertices), std::move(part.triangles), std::move(part.face));
  } catch (const std::invalid_argument&) {
    return nullptr;
  }
}

}  // namespace

std::vector<NamedMesh> load_meshes(const std::string& path, double unit) {
  const Soup soup = read(path, unit);
  std::vector<std::vector<uint32_t>> members(soup.group_names.size());
  for (uint32_t t = 0; t < soup.triangles.size(); ++t) members[soup.group[t]].push_back(t);
  std::vector<uint32_t> number(soup.vertices.size());
  std::vector<NamedMesh> meshes;
  for (size_t g = 0; g < members.size(); ++g) {
    const std::string stem = std::filesystem::path(path).stem().string();
    const std::string& name = soup.group_names[g].empty() ? stem : soup.group_names[g];
    if (MeshPtr mesh = mesh_of(part_of(soup, members[g], number))) meshes.push_back({name, std::move(mesh)});
  }
  if (meshes.empty()) throw FileError(path + ": has no face with an area");
  return meshes;
}

MeshPtr load_mesh(const std::string& path, double unit) {
  Soup soup = read(path, unit);
  MeshPtr mesh = mesh_of({std::move(soup.vertices), std::move(soup.triangles), std::move(soup.face)});
  if (!mesh) throw FileError(path + ": has no face with an area");
  return mesh;
}

}  // namespace echopath
