#include "echopath/replay/factors/launch_cell.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/principal_axes.h"

namespace echopath {
namespace {

constexpr double kFlatRatio = 5e-5;      // ratio of the principal curvatures below which the lesser direction is flat: few
                                         // triangles of bodies that bend both ways come so near to a cylinder by chance
constexpr double kFlatCurvature = 1e-6;  // 1/m: below it a surface is flat

Flatness flatness_of(const PosedHit& hit) {
  if (!hit.is_smooth) return Flatness::kFlat;
  const Vec3 first = hit.normal.unitOrthogonal(), second = hit.normal.cross(first);
  const double k11 = first.dot(hit.curvature * first), k12 = first.dot(hit.curvature * second);
  const double k22 = second.dot(hit.curvature * second);
  const double mean = 0.5 * (k11 + k22), spread = std::hypot(0.5 * (k11 - k22), k12);
  const double large = std::abs(mean) + spread, small = std::abs(std::abs(mean) - spread);
  if (large < kFlatCurvature) return Flatness::kFlat;
  return small < kFlatRatio * large ? Flatness::kFlatOneWay : Flatness::kCurved;
}

// Finds the direction of curvature of a cylinder, in cells.
void find_across(const CellShape& cell, double* across) {
  Eigen::Matrix2d form;
  form << cell.second_form[0], cell.second_form[1], cell.second_form[1], cell.second_form[2];
  const PrincipalAxes principal = principal_axes(form);
  const int bent = std::abs(principal.values[0]) < std::abs(principal.values[1]) ? 1 : 0;
  for (int a = 0; a < 2; ++a) across[a] = principal.axes(a, bent);
}

}  // namespace

LaunchCell recorded_cell(const std::array<float, 7>& record) {
  LaunchCell cell;
  cell.is_curved = cell.is_known = true;
  for (int a = 0; a < 2; ++a) cell.tangent[a] = {record[2 * a], record[2 * a + 1]};
  std::copy(record.begin() + 4, record.end(), cell.turn);
  return cell;
}

CellTangents cell_tangents(const LaunchCell& cell, const PosedHit& hit) {
  CellTangents tangents;
  for (int a = 0; a < 2; ++a) {
    const Vec3 along = cell.tangent[a][0] * hit.edge_u + cell.tangent[a][1] * hit.edge_v;
    tangents[a] = along - hit.normal.dot(along) * hit.normal;
  }
  return tangents;
}

CellShape cell_shape(const LaunchCell& cell, const PosedHit& hit, const CellTangents& t) {
  CellShape shape;
  shape.is_known = cell.is_known;
  shape.is_curved = cell.is_curved;
  shape.flatness = flatness_of(hit);
  for (size_t i = 0; i < 3; ++i) {
    const size_t a = i == 2 ? 1 : 0, b = i == 0 ? 0 : 1;
    shape.product[i] = t[a].dot(t[b]);
    shape.turn[i] = cell.turn[i];
    if (hit.is_smooth) shape.second_form[i] = t[a].dot(hit.curvature * t[b]);
  }
  shape.is_coarse = is_coarse_cell<ScalarMath>(shape.product, cell.facet_area);
  if (shape.flatness == Flatness::kFlatOneWay) find_across(shape, shape.across);
  return shape;
}

// Tangents stretch with their triangle, and so does the solid angle that it takes up as seen from the source.
double root_area(const CellTangents& tangents, const PosedHit& hit, double density) {
  return std::sqrt(tangents[0].cross(tangents[1]).norm() / hit.area_ratio * density);
}

}  // namespace echopath
