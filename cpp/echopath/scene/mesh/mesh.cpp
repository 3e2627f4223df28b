#include "echopath/scene/mesh/mesh.h"

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // OpenMesh copies vectors it is about to set
#endif
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "echopath/base/errors.h"
#include "echopath/base/memory/lazy.h"
#include "echopath/scene/edges/sharp_edges.h"
#include "echopath/scene/mesh/adjacency.h"
#include "echopath/scene/mesh/farthest_vertex.h"
#include "echopath/scene/mesh/manifold.h"

namespace echopath {
namespace {

// Triangles flatter than this have no normal that survives rounding.
constexpr double kMinHeightPerEdge = 1e-12;

struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
  VertexAttributes(0);
  HalfedgeAttributes(0);
  FaceAttributes(0);
};
using HalfedgeMesh = OpenMesh::TriMesh_ArrayKernelT<DoubleTraits>;

bool is_degenerate(const std::vector<Vec3>& vertices, const Triangle& triangle) {
  const Vec3 &a = vertices[triangle[0]], &b = vertices[triangle[1]], &c = vertices[triangle[2]];
  const Vec3 ab = b - a, ac = c - a, bc = c - b;
  const double longest2 = std::max({ab.squaredNorm(), ac.squaredNorm(), bc.squaredNorm()});
  const double height_times_edge = ab.cross(ac).norm();
  return height_times_edge <= kMinHeightPerEdge * longest2;
}

// Renumbers the corners to the vertices in use, which keep their order; returns the old number of each.
std::vector<uint32_t> drop_unused_vertices(std::vector<Triangle>& triangles, size_t num_vertices) {
  std::vector<uint32_t> renumbered(num_vertices, 0), used;
  for (const Triangle& triangle : triangles) {
    for (const uint32_t vertex : triangle) renumbered[vertex] = 1;
  }
  for (uint32_t vertex = 0; vertex < num_vertices; ++vertex) {
    if (renumbered[vertex] == 0) continue;
    renumbered[vertex] = static_cast<uint32_t>(used.size());
    used.push_back(vertex);
  }
  for (Triangle& triangle : triangles) {
    for (uint32_t& vertex : triangle) vertex = renumbered[vertex];
  }
  return used;
}

HalfedgeMesh connect(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  HalfedgeMesh mesh;
  mesh.reserve(vertices.size(), vertices.size() + triangles.size(), triangles.size());
  for (const Vec3& p : vertices) mesh.add_vertex({p.x(), p.y(), p.z()});
  for (const Triangle& t : triangles) {
    const auto handle = [&](int k) { return OpenMesh::VertexHandle(static_cast<int>(t[k])); };
    if (!mesh.add_face(handle(0), handle(1), handle(2)).is_valid()) {
      throw std::logic_error("Mesh: a face is still non-manifold after cutting");
    }
  }
  return mesh;
}

bool has_boundary(const HalfedgeMesh& mesh) {
  for (const auto edge : mesh.edges()) {
    if (mesh.is_boundary(edge)) return true;
  }
  return false;
}

// Returns whether an edge has one triangle only; after cutting to a manifold each edge has one or two.
bool has_boundary(const std::vector<Triangle>& triangles) {
  std::vector<std::pair<uint32_t, uint32_t>> edges;
  edges.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    for (size_t k = 0; k < 3; ++k) edges.push_back(std::minmax(t[k], t[(k + 1) % 3]));
  }
  std::ranges::sort(edges);
  for (size_t i = 0; i < edges.size(); i += 2) {
    if (i + 1 == edges.size() || edges[i] != edges[i + 1]) return true;
  }
  return false;
}

void sort_and_check(std::vector<uint32_t>& triangles, size_t num_triangles) {
  std::ranges::sort(triangles);
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  require(!triangles.empty(), "triangles", "must name one at least", 0);
  require(triangles.back() < num_triangles, "triangles", "must be below their number in the whole mesh", triangles.back());
}

double surface_area(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  double area = 0.0;
  for (const Triangle& triangle : triangles) area += 0.5 * cross_of_sides(vertices, triangle).norm();
  return area;
}

// Compares all vertices with the plane of the first triangle.
bool lie_in_a_plane(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  constexpr double kRelative = 1e-6;
  const Vec3 normal = cross_of_sides(vertices, triangles.front()).normalized(), &origin = vertices[triangles.front()[0]];
  return std::ranges::all_of(vertices, [&](const Vec3& vertex) {
    const Vec3 line = vertex - origin;
    return std::abs(normal.dot(line)) <= kRelative * line.norm();
  });
}

}  // namespace

struct Mesh::Found {
  Lazy<std::vector<SharpEdge>> sharp_edges;
  Lazy<std::vector<std::array<uint32_t, 3>>> neighbours;
};

Mesh::Mesh() : found_(std::make_shared<Found>()) {}

Mesh::Mesh(std::vector<Vec3> vertices, std::vector<Triangle> triangles, std::vector<uint32_t> source_triangle) : Mesh() {
  num_input_vertices_ = std::ssize(vertices);
  constexpr size_t kMaxCount = 0x7fffffff / 3;  // OpenMesh counts half-edges in an int
  require(triangles.size() < kMaxCount, "triangles", "must be fewer than 715 million", triangles.size());
  require(source_triangle.empty() || source_triangle.size() == triangles.size(), "original_triangle",
          "must be empty or as long as triangles", source_triangle.size());
  const std::string rule = "must hold indices below the number of vertices, " + std::to_string(vertices.size());
  for (uint32_t t = 0; t < triangles.size(); ++t) {
    for (const uint32_t vertex : triangles[t]) {
      require(vertex < vertices.size(), "triangles", rule, vertex);
      if (!is_vertex_in_range(vertices[vertex])) {
        require(false, "vertices", "vertex " + std::to_string(vertex) + " must be finite and within 1e70 m",
                vertices[vertex].transpose());
      }
    }
    if (is_degenerate(vertices, triangles[t])) continue;
    triangles_.push_back(triangles[t]);
    original_triangle_.push_back(source_triangle.empty() ? t : source_triangle[t]);
  }
  num_removed_triangles_ = static_cast<int64_t>(triangles.size() - triangles_.size());
  require(!triangles_.empty(), "triangles", "must hold at least one whose area is above the rounding of its corners",
          "0 of " + std::to_string(triangles.size()));

  original_vertex_ = drop_unused_vertices(triangles_, vertices.size());
  const size_t num_used = original_vertex_.size();
  cut_to_manifold(triangles_, original_vertex_);
  num_duplicated_vertices_ = static_cast<int64_t>(original_vertex_.size() - num_used);
  vertices_.reserve(original_vertex_.size());
  for (const uint32_t vertex : original_vertex_) vertices_.push_back(vertices[vertex]);
  is_closed_ = !has_boundary(connect(vertices_, triangles_)) && num_duplicated_vertices_ == 0;
  measure();
}

MeshPtr Mesh::part(const MeshPtr& whole, std::vector<uint32_t> triangles) {
  sort_and_check(triangles, whole->triangles_.size());
  if (whole->whole_) {
    for (uint32_t& triangle : triangles) triangle = whole->whole_triangle_[triangle];
    return part(whole->whole_, std::move(triangles));
  }
  const std::shared_ptr<Mesh> made(new Mesh());
  made->whole_ = whole;
  for (const uint32_t t : triangles) {
    made->triangles_.push_back(whole->triangles_[t]);
    made->original_triangle_.push_back(whole->original_triangle_[t]);
  }
  made->whole_triangle_ = std::move(triangles);
  made->whole_vertex_ = drop_unused_vertices(made->triangles_, whole->vertices_.size());
  const auto num_before_copies = whole->vertices_.size() - static_cast<size_t>(whole->num_duplicated_vertices_);
  for (const uint32_t v : made->whole_vertex_) {
    made->vertices_.push_back(whole->vertices_[v]);
    made->original_vertex_.push_back(whole->original_vertex_[v]);
    made->num_duplicated_vertices_ += v >= num_before_copies ? 1 : 0;
  }
  made->num_input_vertices_ = whole->num_input_vertices_;
  made->is_closed_ = made->num_duplicated_vertices_ == 0 && !has_boundary(made->triangles_);
  made->measure();
  return made;
}

Mesh::~Mesh() = default;

void Mesh::measure() {
  area_ = surface_area(vertices_, triangles_);
  is_flat_ = lie_in_a_plane(vertices_, triangles_);
  box_ = box_about(vertices_);
  boxes_of_runs_ = find_boxes_of_runs(vertices_, triangles_);
}

const std::vector<SharpEdge>& Mesh::sharp_edges() const {
  return found_->sharp_edges.get([&] { return find_sharp_edges(*this); });
}

const std::vector<std::array<uint32_t, 3>>& Mesh::neighbours() const {
  return found_->neighbours.get([&] { return edge_neighbours(vertices_, triangles_); });
}

}  // namespace echopath
