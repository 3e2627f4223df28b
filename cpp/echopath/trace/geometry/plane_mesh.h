#pragma once
// Sorts the triangles of a flat mesh by where they lie, so that a point of its plane finds its triangle without a ray.
#include <array>
#include <optional>
#include <vector>

#include "echopath/record/paths.h"

namespace echopath {

class PlaneMesh {
 public:
  PlaneMesh() = default;
  // `triangles` [F] are IDs, ascending; `corners` [F] are those of the triangles, in m; `normal` is the unit normal of
  // the plane. Triangles of no area hold no point.
  PlaneMesh(uint32_t mesh_id, const std::vector<uint32_t>& triangles, const std::vector<std::array<Vec3, 3>>& corners,
            const Vec3& normal);
  // Returns the hit in the first triangle that holds the foot of a point (m) on the plane, with 1 nm around it; returns
  // nothing outside the mesh.
  std::optional<Hit> locate(const Vec3& point) const;

 private:
  struct Facet {
    uint32_t triangle_id;
    Vec3 corner, along_u, along_v;     // u = along_u.dot(p - corner), likewise v
    double slack_u, slack_v, slack_w;  // change of the barycentric coordinates over 1 nm
    bool holds(double u, double v) const { return u >= -slack_u && v >= -slack_v && 1.0 - u - v >= -slack_w; }
  };
  struct Cell {
    int column, row;
  };
  static Facet facet_of(uint32_t triangle_id, const std::array<Vec3, 3>& corners);
  Cell cell_of(const Vec3& point) const;
  size_t index(Cell cell) const {
    return static_cast<size_t>(cell.row) * static_cast<size_t>(size_) + static_cast<size_t>(cell.column);
  }

  uint32_t mesh_id_ = 0;
  int size_ = 1;                                       // cells per side
  Vec3 first_ = Vec3::Zero(), second_ = Vec3::Zero();  // across the plane, cells per m
  double first_begin_ = 0.0, second_begin_ = 0.0;
  std::vector<std::vector<Facet>> cells_{std::vector<Facet>()};  // [size * size], by triangle ID in each
};

}  // namespace echopath
