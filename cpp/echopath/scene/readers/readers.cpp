#include "echopath/scene/readers/readers.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/scene/mesh/farthest_vertex.h"
#include "echopath/scene/readers/corner_normals.h"
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
  throw FileError(path + ": unknown mesh format '" + extension + "', known are " + known + "; load_model reads more kinds");
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

// Returns the vertices that triangles use, in the order of the file.
std::vector<uint32_t> used_vertices(const Soup& soup, const std::vector<uint32_t>& members) {
  std::vector<uint32_t> used;
  for (const uint32_t t : members) used.insert(used.end(), soup.triangles[t].begin(), soup.triangles[t].end());
  std::ranges::sort(used);
  used.erase(std::unique(used.begin(), used.end()), used.end());
  return used;
}

std::vector<Vec3> chosen(const std::vector<Vec3>& points, const std::vector<uint32_t>& indices) {
  std::vector<Vec3> found;
  for (const uint32_t index : indices) found.push_back(points[index]);
  return found;
}

// Returns null where no triangle has an area.
MeshPtr mesh_of(std::vector<Vec3> vertices, std::vector<Triangle> triangles, std::vector<uint32_t> face) {
  try {
    return std::make_shared<const Mesh>(std::move(vertices), std::move(triangles), std::move(face));
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
  std::ranges::stable_sort(found, {}, &SurfaceFaces::group);
  return found;
}

// Fills in the triangles `members` of a surface with the vertices that they use. `number` [V] is scratch for the vertices'
// numbers in the surface.
void fill(Surfaces::Surface& surface, const Soup& soup, const std::vector<uint32_t>& members,
          std::vector<uint32_t>& number) {
  const std::vector<uint32_t> used = used_vertices(soup, members);
  for (uint32_t i = 0; i < used.size(); ++i) number[used[i]] = i;
  surface.vertices = chosen(soup.vertices, used);
  for (const uint32_t t : members) {
    const Triangle& corners = soup.triangles[t];
    surface.triangles.push_back({number[corners[0]], number[corners[1]], number[corners[2]]});
    surface.face.push_back(soup.face[t]);
  }
}

std::string stem_of(const std::string& path) { return std::filesystem::path(path).stem().string(); }

// Returns a name for what belongs to no group of an object, "rest" unless one of its groups is called so.
std::string name_of_rest(const Soup& soup, const std::string& object) {
  const auto is_taken = [&](const std::string& name) {
    for (size_t group = 0; group < soup.group_names.size(); ++group) {
      if (soup.object_names[group] == object && soup.group_names[group] == name) return true;
    }
    return false;
  };
  std::string name = "rest";
  for (int number = 2; is_taken(name); ++number) name = "rest_" + std::to_string(number);
  return name;
}

std::vector<Surfaces::Surface> surfaces_of(const Soup& soup, const std::string& name) {
  const CornerNormals normals(soup);
  const std::set<std::string> objects(soup.object_names.begin(), soup.object_names.end());  // that have groups
  std::vector<uint32_t> number(soup.vertices.size());
  std::vector<Surfaces::Surface> surfaces;
  for (const SurfaceFaces& faces : faces_by_surface(soup)) {
    Surfaces::Surface& surface = surfaces.emplace_back();
    if (!soup.object_names.empty()) surface.object = soup.object_names[faces.group];
    surface.name = soup.group_names[faces.group].empty() ? stem_of(name) : soup.group_names[faces.group];
    if (surface.object.empty() && objects.contains(surface.name)) {
      surface.object = std::exchange(surface.name, name_of_rest(soup, surface.name));
    }
    if (!soup.material.empty()) surface.material = soup.material_names[faces.material];
    fill(surface, soup, faces.triangles, number);
    if (!normals.are_given(faces.triangles)) continue;
    for (const uint32_t t : faces.triangles) {
      for (const Vec3& normal : normals.of(t)) surface.normals.push_back(normal);
    }
  }
  return surfaces;
}

// Names of groups, "" for one that is called after its file.
std::vector<std::string> own_names(std::vector<std::string> names, const std::string& path) {
  std::replace(names.begin(), names.end(), stem_of(path), std::string());
  return names;
}

bool have_equal_faces(const Soup& a, const std::string& path_of_a, const Soup& b, const std::string& path_of_b) {
  return a.vertices.size() == b.vertices.size() && a.corners == b.corners && a.num_corners == b.num_corners &&
         a.group == b.group && a.material == b.material && a.material_names == b.material_names &&
         own_names(a.object_names, path_of_a) == own_names(b.object_names, path_of_b) &&
         own_names(a.group_names, path_of_a) == own_names(b.group_names, path_of_b);
}

}  // namespace

std::vector<NamedMesh> read_meshes(std::istream& stream, const std::string& name, double unit) {
  check_unit(unit);
  Soup soup = read(stream, name, unit);
  for (auto* given : {&soup.material, &soup.smoothing}) given->clear();  // groups are not taken apart, and need no normals
  soup.normal.clear();
  std::vector<NamedMesh> meshes;
  for (Surfaces::Surface& one : surfaces_of(soup, name)) {
    MeshPtr mesh = mesh_of(std::move(one.vertices), std::move(one.triangles), std::move(one.face));
    if (mesh) meshes.push_back({one.object + (one.object.empty() ? "" : "/") + one.name, std::move(mesh)});
  }
  if (meshes.empty()) throw FileError(name + ": has no face with an area");
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

SurfaceFrames load_frames(const std::vector<std::string>& paths, double unit) {
  require(!paths.empty(), "paths", "must be at least one file", paths.size());
  const auto soup_of = [&](const std::string& path) {
    std::ifstream file = opened(path, unit);
    return read(file, path, unit);
  };
  const Soup first = soup_of(paths[0]);
  SurfaceFrames frames{surfaces_of(first, paths[0]), {}};
  std::vector<std::vector<uint32_t>> used;
  for (const SurfaceFaces& faces : faces_by_surface(first)) used.push_back(used_vertices(first, faces.triangles));
  frames.vertices.resize(used.size());
  for (const std::string& path : paths) {
    const Soup soup = soup_of(path);
    if (!have_equal_faces(soup, path, first, paths[0])) {
      throw FileError(path + ": must have the vertices, faces, groups and materials of the first frame, " +
                      std::filesystem::path(paths[0]).filename().string());
    }
    for (size_t i = 0; i < used.size(); ++i) frames.vertices[i].push_back(chosen(soup.vertices, used[i]));
  }
  return frames;
}

std::vector<NamedMesh> load_meshes(const std::string& path, double unit) {
  std::ifstream file = opened(path, unit);
  return read_meshes(file, path, unit);
}

std::vector<std::string> mesh_extensions() {
  std::vector<std::string> extensions;
  for (const Reader& reader : kReaders) extensions.emplace_back(reader.extension);
  return extensions;
}

MeshPtr load_mesh(const std::string& path, double unit) {
  std::ifstream file = opened(path, unit);
  Soup soup = read(file, path, unit);
  MeshPtr mesh = mesh_of(std::move(soup.vertices), std::move(soup.triangles), std::move(soup.face));
  if (!mesh) throw FileError(path + ": has no face with an area");
  return mesh;
}

}  // namespace echopath
