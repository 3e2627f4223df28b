#include "echopath/scene/readers/readers.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string_view>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/scene/mesh/farthest_vertex.h"
#include "echopath/scene/readers/soup.h"

namespace echopath {
namespace {

struct Reader {
  std::string_view extension;
  Soup (*read)(std::istream& stream, const std::string& name);
};

constexpr Reader kReaders[] = {{".obj", read_obj}, {".ply", read_ply}, {".stl", read_stl}, {".off", read_off}};

const Reader& reader_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string(), known;
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const Reader& reader : kReaders) {
    if (reader.extension == extension) return reader;
    known.append(known.empty() ? "" : ", ").append(reader.extension);
  }
  throw FileError(path + ": unknown mesh format '" + extension + "', known are " + known);
}

void check_unit(double unit) {
  require(std::isfinite(unit) && unit > 0.0, "unit", "must be positive, in metres per file unit", unit);
}

Soup read(std::istream& stream, const std::string& name, double unit) {
  Soup soup = reader_of(name).read(stream, name);
  if (soup.triangles.empty()) throw FileError(name + ": has no faces");
  for (Vec3& vertex : soup.vertices) {
    vertex *= unit;
    if (!is_vertex_in_range(vertex)) throw FileError(name + ": has a vertex beyond 1e70 m");
  }
  return soup;
}

std::ifstream opened(const std::string& path, double unit) {
  check_unit(unit);
  reader_of(path);  // an unknown format is told before a missing file
  if (std::filesystem::is_directory(path)) throw FileError(path + ": is a directory");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw FileError(path + ": cannot be opened");
  return file;
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

// Holds the triangles of one group and material.
struct SurfaceFaces {
  uint32_t group = 0, material = 0;
  std::vector<uint32_t> triangles;
};

// Returns the groups in their order, taken apart by material in the order in which materials appear in them.
std::vector<SurfaceFaces> faces_by_surface(const Soup& soup) {
  std::map<std::pair<uint32_t, uint32_t>, size_t> index;
  std::vector<SurfaceFaces> found;
  for (uint32_t t = 0; t < soup.triangles.size(); ++t) {
    const uint32_t material = soup.material.empty() ? 0 : soup.material[t];
    const auto [entry, added] = index.try_emplace({soup.group[t], material}, found.size());
    if (added) found.push_back({soup.group[t], material, {}});
    found[entry->second].triangles.push_back(t);
  }
  const auto is_before = [](const SurfaceFaces& a, const SurfaceFaces& b) { return a.group < b.group; };
  std::stable_sort(found.begin(), found.end(), is_before);
  return found;
}

std::vector<Surfaces::Surface> surfaces_of(const Soup& soup, const std::string& name) {
  std::vector<uint32_t> number(soup.vertices.size());
  std::vector<Surfaces::Surface> surfaces;
  const std::string stem = std::filesystem::path(name).stem().string();
  for (const SurfaceFaces& faces : faces_by_surface(soup)) {
    const std::string& group = soup.group_names[faces.group].empty() ? stem : soup.group_names[faces.group];
    const std::string material = soup.material.empty() ? "" : soup.material_names[faces.material];
    MeshPtr mesh = mesh_of(part_of(soup, faces.triangles, number));
    if (mesh) surfaces.push_back({group, material, std::move(mesh)});
  }
  if (surfaces.empty()) throw FileError(name + ": has no face with an area");
  return surfaces;
}

}  // namespace

std::vector<NamedMesh> read_meshes(std::istream& stream, const std::string& name, double unit) {
  check_unit(unit);
  Soup soup = read(stream, name, unit);
  soup.material.clear();  // groups are not taken apart
  std::vector<NamedMesh> meshes;
  for (Surfaces::Surface& one : surfaces_of(soup, name)) meshes.push_back({std::move(one.name), std::move(one.mesh)});
  return meshes;
}

Surfaces read_surfaces(std::istream& stream, const std::string& name, double unit) {
  check_unit(unit);
  const Soup soup = read(stream, name, unit);
  return {surfaces_of(soup, name), soup.material_files};
}

Surfaces load_surfaces(const std::string& path, double unit) {
  std::ifstream file = opened(path, unit);
  return read_surfaces(file, path, unit);
}

std::vector<NamedMesh> load_meshes(const std::string& path, double unit) {
  std::ifstream file = opened(path, unit);
  return read_meshes(file, path, unit);
}

MeshPtr load_mesh(const std::string& path, double unit) {
  std::ifstream file = opened(path, unit);
  Soup soup = read(file, path, unit);
  MeshPtr mesh = mesh_of({std::move(soup.vertices), std::move(soup.triangles), std::move(soup.face)});
  if (!mesh) throw FileError(path + ": has no face with an area");
  return mesh;
}

}  // namespace echopath
