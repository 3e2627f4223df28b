#include "echopath/trace/geometry/plane_mesh.h"

#include <algorithm>
#include <cmath>

namespace echopath {
namespace {

constexpr double kOutside = 1e-9;  // m: how far outside its triangle a point may lie

}  // namespace

PlaneMesh::Facet PlaneMesh::facet_of(uint32_t triangle_id, const std::array<Vec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vec3 normal = cross_of_sides(a, b, c);
  const double squared = normal.squaredNorm();
  Facet facet{triangle_id, a, (c - a).cross(normal) / squared, normal.cross(b - a) / squared, 0.0, 0.0, 0.0};
  facet.slack_u = kOutside * facet.along_u.norm();
  facet.slack_v = kOutside * facet.along_v.norm();
  facet.slack_w = kOutside * (facet.along_u + facet.along_v).norm();
  return facet;
}

PlaneMesh::PlaneMesh(uint32_t mesh_id, const std::vector<uint32_t>& triangles,
                     const std::vector<std::array<Vec3, 3>>& corners, const Vec3& normal)
    : mesh_id_(mesh_id), size_(std::max(1, static_cast<int>(std::sqrt(static_cast<double>(corners.size()) / 4.0)))) {
  const Vec3 first = normal.unitOrthogonal(), second = normal.cross(first);
  Eigen::AlignedBox2d box;
  for (const auto& triangle : corners) {
    for (const Vec3& corner : triangle) box.extend(Eigen::Vector2d(first.dot(corner), second.dot(corner)));
  }
  const Eigen::Vector2d extent = box.isEmpty() ? Eigen::Vector2d(1.0, 1.0) : Eigen::Vector2d(box.sizes().cwiseMax(1e-9));
  first_ = first * (size_ / extent[0]);
  second_ = second * (size_ / extent[1]);
  first_begin_ = box.isEmpty() ? 0.0 : box.min()[0] * size_ / extent[0];
  second_begin_ = box.isEmpty() ? 0.0 : box.min()[1] * size_ / extent[1];
  cells_.resize(static_cast<size_t>(size_) * static_cast<size_t>(size_));
  for (size_t id = 0; id < corners.size(); ++id) {
    const Facet facet = facet_of(triangles[id], corners[id]);
    if (!facet.along_u.allFinite() || !facet.along_v.allFinite()) continue;
    Cell low{size_, size_}, high{0, 0};
    for (const Vec3& corner : corners[id]) {
      const Cell cell = cell_of(corner);
      low = {std::min(low.column, cell.column), std::min(low.row, cell.row)};
      high = {std::max(high.column, cell.column), std::max(high.row, cell.row)};
    }
    for (int row = low.row; row <= high.row; ++row) {
      for (int column = low.column; column <= high.column; ++column) cells_[index({column, row})].push_back(facet);
    }
  }
}

PlaneMesh::Cell PlaneMesh::cell_of(const Vec3& point) const {
  const auto along = [&](const Vec3& axis, double begin) {
    return static_cast<int>(std::clamp(axis.dot(point) - begin, 0.0, static_cast<double>(size_ - 1)));
  };
  return {along(first_, first_begin_), along(second_, second_begin_)};
}

std::optional<Hit> PlaneMesh::locate(const Vec3& point) const {
  const Cell cell = cell_of(point);
  for (const Facet& facet : cells_[index(cell)]) {
    const Vec3 line = point - facet.corner;
    const double u = facet.along_u.dot(line), v = facet.along_v.dot(line);
    if (facet.holds(u, v)) return Hit{mesh_id_, facet.triangle_id, static_cast<float>(u), static_cast<float>(v)};
  }
  return std::nullopt;
}

}  // namespace echopath
