#include "echopath/replay/launch_cell.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace echopath {
namespace {

constexpr double kFlatPhase = 0.05;         // rad: quadratic phase (spread^2 h) below which a flat facet is flat-top
constexpr double kFlatRatio = 1e-3;         // of both principal curvatures: below it the lesser direction is flat
constexpr double kFlatCurvature = 1e-6;     // 1/m: below it a surface is flat

// Flatness is a property of the surface, not of the cell: a filter that changed its kind where cells grow (toward grazing)
// would draw an edge across the surface, and the edge would radiate.
enum class Flatness { kFlat, kFlatOneWay, kCurved };

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

struct Tangents {
  Vec3 t[2];
};

Tangents tangents_of(const LaunchCell& cell, const PosedHit& hit) {
  Tangents tangents;
  for (int a = 0; a < 2; ++a) {
    const Vec3 along = cell.tangent[a][0] * hit.edge_u + cell.tangent[a][1] * hit.edge_v;
    tangents.t[a] = along - hit.normal.dot(along) * hit.normal;
  }
  return tangents;
}

// T_a.U_b of the wave front plus the receive sphere; without the surface.
Eigen::Matrix2d front_phase(const LaunchCell& cell, const HitGeometry& at, const Tangents& tangents) {
  const double inverse_in = 1.0 / at.length_in, inverse_out = 1.0 / at.length_out;
  double along_arrival[2], along_departure[2];
  for (int a = 0; a < 2; ++a) {
    along_arrival[a] = tangents.t[a].dot(at.arrival);
    along_departure[a] = tangents.t[a].dot(at.departure);
  }
  const auto entry = [&](int a, int b) {
    const double product = tangents.t[a].dot(tangents.t[b]);
    const double turn = cell.is_curved ? cell.turn[a + b] : (product - along_arrival[a] * along_arrival[b]) * inverse_in;
    return turn + (product - along_departure[a] * along_departure[b]) * inverse_out;
  };
  Eigen::Matrix2d h;
  h(0, 0) = entry(0, 0);
  h(1, 1) = entry(1, 1);
  h(0, 1) = h(1, 0) = entry(0, 1);
  return h;
}

Eigen::Matrix2d surface_phase(const HitGeometry& at, const Tangents& tangents) {
  Eigen::Matrix2d h = Eigen::Matrix2d::Zero();
  if (!at.hit.is_smooth) return h;
  // The normal's side: a surface seen from inside is concave.
  const double side = at.hit.normal.dot(at.arrival) < 0 ? 1.0 : -1.0;
  for (int a = 0; a < 2; ++a) {
    for (int b = 0; b < 2; ++b) h(a, b) = side * (at.cos_in + at.cos_out) * tangents.t[a].dot(at.hit.curvature * tangents.t[b]);
  }
  return h;
}

std::complex<double> second_order(const LaunchCell& cell, const HitGeometry& at, const Tangents& tangents,
                                  const Eigen::Vector2d& g, const CellFilter& filter) {
  const Eigen::Matrix2d front = filter.wavenumber * front_phase(cell, at, tangents);
  const Eigen::Matrix2d surface = filter.wavenumber * surface_phase(at, tangents);
  const Eigen::Matrix2d h = front + surface;
  const FootprintPhase whole{g[0], g[1], h(0, 0), h(0, 1), h(1, 1)};
  const auto quadratic = filter.order == Footprint::kEdges ? edges_footprint : second_order_footprint;
  const Flatness flatness = flatness_of(at.hit);
  if (cell.is_curved || flatness == Flatness::kCurved) return quadratic(whole, filter.spread);
  if (flatness == Flatness::kFlat) {
    const bool is_flat = h.cwiseAbs().maxCoeff() * filter.spread * filter.spread < kFlatPhase;
    return is_flat ? flat_top_footprint(whole) : quadratic(whole, filter.spread);
  }
  // Along the axis of a cylinder the facets are as long as the cylinder: flat-top there, second order across.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(surface);
  const int flat = std::abs(axes.eigenvalues()[0]) < std::abs(axes.eigenvalues()[1]) ? 0 : 1;
  const Eigen::Vector2d along = axes.eigenvectors().col(flat), across = axes.eigenvectors().col(1 - flat);
  return flat_top_footprint({along.dot(g), 0.0, 0.0, 0.0, 0.0}) *
         quadratic({across.dot(g), 0.0, across.dot(h * across), 0.0, 0.0}, filter.spread);
}

}  // namespace

double root_tube_area(const LaunchCell& cell, const HitGeometry& at) {
  if (!cell.is_curved) return at.length_in;
  // Tangents stretch with their triangle, and so does the solid angle that it takes of the source.
  const Tangents tangents = tangents_of(cell, at.hit);
  return std::sqrt(tangents.t[0].cross(tangents.t[1]).norm() / at.hit.area_ratio * at.cos_in * cell.ray_density);
}

std::complex<double> cell_filter(const LaunchCell& cell, const HitGeometry& at, const CellFilter& filter) {
  if (filter.order == Footprint::kNone || !cell.is_known) return 1.0;
  const Tangents tangents = tangents_of(cell, at.hit);
  const Vec3 mismatch = filter.wavenumber * (at.arrival - at.departure);
  const Eigen::Vector2d g(mismatch.dot(tangents.t[0]), mismatch.dot(tangents.t[1]));
  if (filter.order == Footprint::kFirstOrder) return first_order_footprint({g[0], g[1], 0.0, 0.0, 0.0});
  return second_order(cell, at, tangents, g, filter);
}

}  // namespace echopath
