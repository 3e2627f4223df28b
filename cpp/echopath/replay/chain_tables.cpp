#include "echopath/replay/chain_tables.h"

#include <cmath>
#include <deque>

#include "echopath/base/simd.h"
#include "echopath/replay/diffuse_chain.h"

namespace echopath {
namespace {

void store(const Vec3& vector, NodeRows& rows, size_t entry, size_t first_row, size_t node) {
  for (int axis = 0; axis < 3; ++axis) rows.row(entry, first_row + static_cast<size_t>(axis))[node] = vector[axis];
}

Vec3 load(const NodeRows& rows, size_t entry, size_t first_row, size_t node) {
  return {rows.row(entry, first_row)[node], rows.row(entry, first_row + 1)[node], rows.row(entry, first_row + 2)[node]};
}

// Rows [normal x, y, z, offset]: the points x with normal.x = offset, m.
NodeRows pose_mirrors(const ChainPlan& plan, const Localiser& localise, std::span<const Instant> instants) {
  NodeRows planes(plan.mirrors.size(), 4, instants.size());
  for (size_t mirror = 0; mirror < plan.mirrors.size(); ++mirror) {
    const LocalHit local = localise.hit(plan.mirrors[mirror]);
    for (size_t node = 0; node < instants.size(); ++node) {
      PosedHit posed;
      pose_hit(local, instants[node], false, posed);
      store(posed.normal, planes, mirror, 0, node);
      planes.row(mirror, 3)[node] = posed.normal.dot(posed.point);
    }
  }
  return planes;
}

const std::vector<PosedAntenna>& antennas_of(const Instant& instant, bool of_receivers) {
  return of_receivers ? instant.receivers : instant.transmitters;
}

// Of the antennas themselves.
void store_antennas(std::span<const Instant> instants, bool of_receivers, AntennaImages& images) {
  for (size_t node = 0; node < instants.size(); ++node) {
    for (size_t antenna = 0; antenna < images.num_antennas; ++antenna) {
      const PosedAntenna& posed = antennas_of(instants[node], of_receivers)[antenna];
      store(posed.position, images.rows, antenna, AntennaImages::kPosition, node);
      store(posed.boresight, images.rows, antenna, AntennaImages::kBoresight, node);
      if (!images.antenna_from_image.empty()) images.antenna_from_image[antenna * instants.size() + node] = posed.antenna_from_world;
    }
  }
}

// One more mirror: `from` and `to` count antennas of images.
void store_image(const NodeRows& planes, size_t mirror, size_t from, size_t to, AntennaImages& images) {
  const size_t num_nodes = images.rows.num_nodes();
  for (size_t node = 0; node < num_nodes; ++node) {
    const Vec3 normal = load(planes, mirror, 0, node);
    const Vec3 position = load(images.rows, from, AntennaImages::kPosition, node);
    const Vec3 boresight = load(images.rows, from, AntennaImages::kBoresight, node);
    const double behind = normal.dot(position) - planes.row(mirror, 3)[node];
    store(position - 2.0 * behind * normal, images.rows, to, AntennaImages::kPosition, node);
    store(boresight - 2.0 * normal.dot(boresight) * normal, images.rows, to, AntennaImages::kBoresight, node);
    if (images.antenna_from_image.empty()) continue;
    const Mat3 reflection = Mat3::Identity() - 2.0 * normal * normal.transpose();
    images.antenna_from_image[to * num_nodes + node] = images.antenna_from_image[from * num_nodes + node] * reflection;
  }
}

// From the image of an antenna to a point. Pointers to the first of three rows where those are vectors.
struct LegRows {
  const double *image, *boresight, *point, *normal;
  double *length, *cos_point, *cos_boresight;
};

ECHOPATH_INLINE void measure(LegRows leg, size_t num_nodes) {
  const double *ix = leg.image, *iy = ix + num_nodes, *iz = iy + num_nodes;
  const double *bx = leg.boresight, *by = bx + num_nodes, *bz = by + num_nodes;
  const double *px = leg.point, *py = px + num_nodes, *pz = py + num_nodes;
  const double *nx = leg.normal, *ny = nx + num_nodes, *nz = ny + num_nodes;
  double *__restrict length = leg.length, *__restrict cos_point = leg.cos_point, *__restrict cos_boresight = leg.cos_boresight;
  for (size_t node = 0; node < num_nodes; ++node) {
    const double x = px[node] - ix[node], y = py[node] - iy[node], z = pz[node] - iz[node];
    const double distance = std::sqrt(x * x + y * y + z * z), inverse = 1.0 / distance;
    length[node] = distance;
    cos_point[node] = -inverse * (nx[node] * x + ny[node] * y + nz[node] * z);
    cos_boresight[node] = inverse * (bx[node] * x + by[node] * y + bz[node] * z);
  }
}

// Gains over the cosines of the boresight, in place; of tables over the directions from the image to the point.
void find_root_gains(const AntennaImages& images, size_t entry, const double* point, double* gain) {
  const size_t num_nodes = images.rows.num_nodes();
  const AntennaPattern& pattern = *images.pattern[entry % images.num_antennas];
  if (pattern.kind != AntennaPattern::Kind::kTable) {
    for (size_t node = 0; node < num_nodes; ++node) gain[node] = std::sqrt(pattern.gain(gain[node]));
    return;
  }
  for (size_t node = 0; node < num_nodes; ++node) {
    const Vec3 at(point[node], point[num_nodes + node], point[2 * num_nodes + node]);
    const Vec3 direction = (at - load(images.rows, entry, AntennaImages::kPosition, node)).normalized();
    gain[node] = std::sqrt(pattern.toward(images.antenna_from_image[entry * num_nodes + node] * direction).power);
  }
}

ECHOPATH_INLINE void find_factors(const double* root_gain, const double* cosine, const double* length, size_t num_nodes,
                                double* __restrict factor) {
  for (size_t node = 0; node < num_nodes; ++node) factor[node] = diffuse_leg(root_gain[node], cosine[node], length[node]);
}

}  // namespace

PosedHit PosedPoints::at(size_t point, size_t node) const {
  PosedHit hit;
  hit.point = load(rows, point, kPosition, node);
  hit.normal = load(rows, point, kNormal, node);
  hit.area_ratio = rows.row(point, kAreaRatio)[node];
  return hit;
}

PosedPoints pose_points(const ChainPlan& plan, const Localiser& localise, std::span<const Instant> instants) {
  PosedPoints points{NodeRows(plan.points.size(), PosedPoints::kNumRows, instants.size())};
  std::deque<std::array<Vec3, 3>> normals;
  for (size_t point = 0; point < plan.points.size(); ++point) {
    const LocalHit local = localise.hit(plan.points[point], normals);
    for (size_t node = 0; node < instants.size(); ++node) {
      PosedHit posed;
      pose_hit(local, instants[node], false, posed);
      store(posed.point, points.rows, point, PosedPoints::kPosition, node);
      store(posed.normal, points.rows, point, PosedPoints::kNormal, node);
      points.rows.row(point, PosedPoints::kAreaRatio)[node] = posed.area_ratio;
    }
  }
  return points;
}

AntennaImages pose_images(const ChainPlan& plan, const Localiser& localise, std::span<const Instant> instants, bool of_receivers) {
  AntennaImages images;
  const std::vector<PosedAntenna>& antennas = antennas_of(instants.front(), of_receivers);
  images.num_antennas = antennas.size();
  bool has_table = false;
  for (const PosedAntenna& antenna : antennas) {
    images.pattern.push_back(antenna.pattern);
    has_table = has_table || antenna.pattern->kind == AntennaPattern::Kind::kTable;
  }
  const size_t num_entries = plan.images.size() * images.num_antennas;
  images.rows = NodeRows(num_entries, AntennaImages::kNumRows, instants.size());
  if (has_table) images.antenna_from_image.resize(num_entries * instants.size());
  store_antennas(instants, of_receivers, images);
  const NodeRows planes = pose_mirrors(plan, localise, instants);
  for (size_t image = 1; image < plan.images.size(); ++image) {
    for (size_t antenna = 0; antenna < images.num_antennas; ++antenna) {
      store_image(planes, plan.images[image].mirror, plan.images[image].parent * images.num_antennas + antenna,
                  image * images.num_antennas + antenna, images);
    }
  }
  return images;
}

ChainLegs measure_legs(const ChainPlan& plan, const PosedPoints& points, const AntennaImages& transmitters,
                       const AntennaImages& receivers) {
  const size_t num_nodes = points.rows.num_nodes();
  ChainLegs legs;
  legs.stride = std::max(transmitters.num_antennas, receivers.num_antennas);
  legs.rows = NodeRows(plan.legs.size() * legs.stride, ChainLegs::kNumRows, num_nodes);
  std::vector<double> cosine(num_nodes), root_gain(num_nodes);
  for (size_t id = 0; id < plan.legs.size(); ++id) {
    const ChainPlan::Leg& leg = plan.legs[id];
    const AntennaImages& images = leg.of_receivers ? receivers : transmitters;
    for (size_t antenna = 0; antenna < images.num_antennas; ++antenna) {
      const size_t image = leg.image * images.num_antennas + antenna, to = id * legs.stride + antenna;
      const double* point = points.rows.row(leg.point, PosedPoints::kPosition);
      double* length = legs.rows.row(to, ChainLegs::kLength);
      double* factor = legs.rows.row(to, ChainLegs::kFactor);
      double* gain = leg.is_diffuse ? root_gain.data() : factor;
      const LegRows rows{images.rows.row(image, AntennaImages::kPosition), images.rows.row(image, AntennaImages::kBoresight), point,
                         points.rows.row(leg.point, PosedPoints::kNormal), length, cosine.data(), gain};
      run_simd<measure>(rows, num_nodes);
      find_root_gains(images, image, point, gain);
      if (leg.is_diffuse) run_simd<find_factors>(gain, cosine.data(), length, num_nodes, factor);
    }
  }
  return legs;
}

ChainInner measure_inner(const ChainPlan& plan, const PosedPoints& points) {
  const size_t num_nodes = points.rows.num_nodes();
  ChainInner out{std::vector<uint8_t>(plan.inner.size()), std::vector<uint8_t>(plan.inner.size()),
                 NodeRows(plan.inner.size(), ChainInner::kNumRows, num_nodes)};
  std::vector<PosedHit> hits(64);  // a path has no more
  for (size_t id = 0; id < plan.inner.size(); ++id) {
    const ChainPlan::Inner& inner = plan.inner[id];
    LocalPath path;
    path.count = static_cast<int>(inner.end - inner.begin);
    path.diffuse = inner.diffuse;
    path.image = inner.image;
    path.first_material = 0;
    path.last_material = path.count - 1;
    for (size_t node = 0; node < num_nodes; ++node) {
      for (size_t k = inner.begin; k < inner.end; ++k) hits[k - inner.begin] = points.at(plan.inner_points[k], node);
      const InnerPart part = inner_part(path, hits.data());
      const DiffuseInner found = diffuse_inner(path, hits.data(), part);
      out.begins_specular[id] = found.begins_specular;
      out.is_single[id] = found.is_single;
      out.rows.row(id, ChainInner::kLength)[node] = part.length;
      out.rows.row(id, ChainInner::kToFirst)[node] = found.to_first;
      out.rows.row(id, ChainInner::kRootCosFirst)[node] = found.root_cos_first;
      out.rows.row(id, ChainInner::kFactor)[node] = found.factor;
      out.rows.row(id, ChainInner::kFirstSign)[node] = found.first_sign;
      out.rows.row(id, ChainInner::kLastSign)[node] = found.last_sign;
    }
  }
  return out;
}

}  // namespace echopath
