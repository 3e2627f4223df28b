#include "echopath/replay/chain_tables.h"

#include <algorithm>
#include <cmath>

#include "echopath/replay/diffuse_chain.h"

namespace echopath {
namespace {

constexpr int kMostExponent = 16;  // of gains that are products of cosines

void find_mirrors(const ChainPlan& plan, const Localiser& localise, const LevelView& level, NodeRows& planes) {
  planes.resize(plan.mirrors.size(), 4, level.instants.size());
  for (size_t mirror = 0; mirror < plan.mirrors.size(); ++mirror) {
    const LocalHit local = localise.hit(plan.mirrors[mirror]);
    for (size_t node = 0; node < level.instants.size(); ++node) {
      PosedHit posed;
      pose_hit(local, level.instants[node], false, posed);
      store(posed.normal, planes, mirror, 0, node);
      planes.row(mirror, 3)[node] = posed.normal.dot(posed.point);
    }
  }
}

// Of the antennas themselves, as axes that tables of gains need.
void store_axes(std::span<const Instant> instants, bool of_receivers, AntennaImages& images) {
  for (size_t node = 0; node < instants.size(); ++node) {
    for (size_t antenna = 0; antenna < images.num_antennas; ++antenna) {
      images.antenna_from_image[antenna * instants.size() + node] = antennas_of(instants[node], of_receivers)[antenna].antenna_from_world;
    }
  }
}

// One more mirror: `from` and `to` count antennas of images.
void store_image(const NodeRows& planes, size_t mirror, size_t from, size_t to, AntennaImages& images) {
  const size_t num_nodes = images.rows.num_nodes();
  for (size_t node = 0; node < num_nodes; ++node) {
    const Vec3 normal = load(planes, mirror, 0, node);
    const Vec3 position = load(images.rows, from, LegToMeasure::kImagePosition, node);
    const Vec3 boresight = load(images.rows, from, LegToMeasure::kBoresight, node);
    const double behind = normal.dot(position) - planes.row(mirror, 3)[node];
    store(position - 2.0 * behind * normal, images.rows, to, LegToMeasure::kImagePosition, node);
    store(boresight - 2.0 * normal.dot(boresight) * normal, images.rows, to, LegToMeasure::kBoresight, node);
    if (images.antenna_from_image.empty()) continue;
    const Mat3 reflection = Mat3::Identity() - 2.0 * normal * normal.transpose();
    images.antenna_from_image[to * num_nodes + node] = images.antenna_from_image[from * num_nodes + node] * reflection;
  }
  pad(images.rows, to, LegToMeasure::kNumImageRows);
}

}  // namespace

int exponent_of(const AntennaPattern& pattern) {
  if (pattern.kind == AntennaPattern::Kind::kIsotropic) return 0;
  if (pattern.kind == AntennaPattern::Kind::kTable || pattern.exponent > kMostExponent) return LegToMeasure::kNoExponent;
  const int whole = static_cast<int>(pattern.exponent);
  // Behind the antenna there is no gain even where the exponent is 0, which the kernel takes as a gain in all directions.
  return whole == pattern.exponent && whole > 0 ? whole : LegToMeasure::kNoExponent;
}

namespace {

// Turns the cosines that the kernel left into gains and factors.
void finish_leg(const AntennaImages& images, size_t entry, const double* point, double* out, size_t stride) {
  const size_t num_nodes = images.rows.num_nodes();
  const AntennaPattern& pattern = *images.pattern[entry % images.num_antennas];
  const bool is_table = pattern.kind == AntennaPattern::Kind::kTable;
  const double* length = out + LegToMeasure::kLength * stride;
  double *factor = out + LegToMeasure::kFactor * stride, *gain = out + LegToMeasure::kGain * stride;
  for (size_t node = 0; node < num_nodes; ++node) {
    if (is_table) {
      const Vec3 at(point[node], point[stride + node], point[2 * stride + node]);
      const Vec3 direction = (at - load(images.rows, entry, LegToMeasure::kImagePosition, node)).normalized();
      gain[node] = std::sqrt(pattern.toward(images.antenna_from_image[entry * num_nodes + node] * direction).power);
    } else {
      gain[node] = std::sqrt(pattern.gain(gain[node]));
    }
    factor[node] = diffuse_leg<ScalarMath>(gain[node], factor[node], length[node]);
  }
}

}  // namespace

PosedHit PosedPoints::at(size_t point, size_t node) const {
  PosedHit hit;
  hit.point = load(rows, point, PointToPose::kPosition, node);
  hit.normal = load(rows, point, PointToPose::kNormal, node);
  hit.area_ratio = rows.row(point, PointToPose::kAreaRatio)[node];
  return hit;
}

PosedHit PosedPoints::at_trace(size_t point) const {
  PosedHit hit;
  hit.point = traced[point].position;
  hit.normal = traced[point].normal;
  hit.is_smooth = traced[point].curvature != nullptr;
  if (hit.is_smooth) hit.curvature = *traced[point].curvature;
  return hit;
}

void PosedPoints::find(const ChainPlan& plan, const Localiser& localise, const LevelView& level) {
  rows.resize(plan.points.size(), PointToPose::kNumRows, level.instants.size());
  traced.resize(plan.points.size());
  normals.clear();
  curvatures.clear();
  for (size_t point = 0; point < plan.points.size(); ++point) {
    const LocalHit hit = localise.hit(plan.points[point], normals);
    if (localise.may_stretch(hit.mesh_id)) pose_stretched(hit, localise, level, point);
    else pose_rigid(hit, localise, level, point);
  }
}

// What is smooth is so in the frame of its mesh: the point off its facet and the normal there move as any other.
void PosedPoints::pose_rigid(const LocalHit& hit, const Localiser& localise, const LevelView& level, size_t point) {
  const Instant& trace = localise.trace_instant();
  const Mat3& mesh_from_trace = localise.mesh_from_trace(hit.mesh_id);
  PosedHit posed;
  pose_hit(hit, trace, false, posed);
  Vec3 position = hit.point;
  traced[point] = {posed.point, posed.normal, nullptr};
  if (posed.is_smooth) {
    traced[point].curvature = &curvatures.emplace_back(posed.curvature);
    position = mesh_from_trace * (posed.point - trace.translation(hit.mesh_id));
  }
  const Vec3 normal = mesh_from_trace * posed.normal;
  PointToPose to;
  to.mesh = level.poses.meshes.row(hit.mesh_id, 0);
  std::copy_n(position.data(), 3, to.position);
  std::copy_n(normal.data(), 3, to.normal);
  to.out = rows.row(point, 0);
  chain_kernels(rows.stride()).pose(to, rows.stride());
}

void PosedPoints::pose_stretched(const LocalHit& hit, const Localiser& localise, const LevelView& level, size_t point) {
  PosedHit posed;
  pose_hit(hit, localise.trace_instant(), false, posed);
  traced[point] = {posed.point, posed.normal, nullptr};
  for (size_t node = 0; node < level.instants.size(); ++node) {
    pose_hit(hit, level.instants[node], false, posed);
    store(posed.point, rows, point, PointToPose::kPosition, node);
    store(posed.normal, rows, point, PointToPose::kNormal, node);
    rows.row(point, PointToPose::kAreaRatio)[node] = posed.area_ratio;
  }
  pad(rows, point, PointToPose::kNumRows);
}

void AntennaImages::find(const ChainPlan& plan, const NodeRows& mirrors, const LevelView& level, bool of_receivers) {
  const std::vector<PosedAntenna>& antennas = antennas_of(level.instants.front(), of_receivers);
  const NodeRows& own = level.poses.antennas[of_receivers];
  num_antennas = antennas.size();
  pattern.clear();
  bool has_table = false;
  for (const PosedAntenna& antenna : antennas) {
    pattern.push_back(antenna.pattern);
    has_table = has_table || antenna.pattern->kind == AntennaPattern::Kind::kTable;
  }
  const size_t num_entries = plan.images.size() * num_antennas;
  rows.resize(num_entries, LegToMeasure::kNumImageRows, level.instants.size());
  antenna_from_image.resize(has_table ? num_entries * level.instants.size() : 0);
  if (has_table) store_axes(level.instants, of_receivers, *this);
  for (size_t antenna = 0; antenna < num_antennas; ++antenna) {
    std::copy_n(own.row(antenna, 0), LegToMeasure::kNumImageRows * rows.stride(), rows.row(antenna, 0));
  }
  for (size_t image = 1; image < plan.images.size(); ++image) {
    for (size_t antenna = 0; antenna < num_antennas; ++antenna) {
      store_image(mirrors, plan.images[image].mirror, plan.images[image].parent * num_antennas + antenna,
                  image * num_antennas + antenna, *this);
    }
  }
}

void ChainLegs::find(const ChainPlan& plan, const PosedPoints& points, const AntennaImages& transmitters,
                     const AntennaImages& receivers) {
  stride = std::max(transmitters.num_antennas, receivers.num_antennas);
  rows.resize(plan.legs.size() * stride, LegToMeasure::kNumRows, points.rows.num_nodes());
  const ChainKernels& kernels = chain_kernels(rows.stride());
  for (size_t id = 0; id < plan.legs.size(); ++id) {
    const ChainPlan::Leg& leg = plan.legs[id];
    const AntennaImages& images = leg.of_receivers ? receivers : transmitters;
    for (size_t antenna = 0; antenna < images.num_antennas; ++antenna) {
      const size_t image = leg.image * images.num_antennas + antenna;
      const AntennaPattern& pattern = *images.pattern[antenna];
      const LegToMeasure measured{images.rows.row(image, 0), points.rows.row(leg.point, 0), exponent_of(pattern),
                                  std::sqrt(pattern.peak_gain), rows.row(id * stride + antenna, 0)};
      kernels.measure(measured, rows.stride());
      if (measured.exponent == LegToMeasure::kNoExponent) finish_leg(images, image, measured.point, measured.out, rows.stride());
    }
  }
}

// Axes of the world for the antennas themselves, and what each mirror makes of them.
void LegPolarizations::find_axes(const ChainPlan& plan, const NodeRows& mirrors) {
  for (size_t image = 0; image < plan.images.size(); ++image) {
    for (int axis = 0; axis < 3; ++axis) {
      const size_t row = ComponentsToFind::kAxes + 3 * static_cast<size_t>(axis);
      for (size_t node = 0; node < axes.num_nodes(); ++node) {
        Vec3 seen = Vec3::Unit(axis);
        if (image > 0) {
          const Vec3 normal = load(mirrors, plan.images[image].mirror, 0, node);
          seen = load(axes, plan.images[image].parent, row, node);
          seen -= 2.0 * normal.dot(seen) * normal;
        }
        store(seen, axes, image, row, node);
      }
    }
    pad(axes, image, ComponentsToFind::kNumAxisRows);
  }
}

void LegPolarizations::find(const ChainPlan& plan, const ChainTables& tables, const LevelView& level) {
  const size_t num_nodes = level.instants.size(), stride = tables.legs.stride;
  axes.resize(plan.images.size(), ComponentsToFind::kNumAxisRows, num_nodes);
  find_axes(plan, tables.mirrors);
  rows.resize(plan.legs.size() * stride, ComponentsToFind::kNumRows, num_nodes);
  const ChainKernels& kernels = chain_kernels(rows.stride());
  for (size_t id = 0; id < plan.legs.size(); ++id) {
    const ChainPlan::Leg& leg = plan.legs[id];
    const AntennaImages& images = tables.images[leg.of_receivers];
    for (size_t antenna = 0; antenna < images.num_antennas; ++antenna) {
      kernels.find_components({images.rows.row(leg.image * images.num_antennas + antenna, 0), axes.row(leg.image, 0),
                               level.poses.polarizations[leg.of_receivers].row(antenna, 0), tables.points.rows.row(leg.point, 0),
                               rows.row(id * stride + antenna, 0)},
                              rows.stride());
    }
  }
}

LocalPath path_of(const ChainPlan::Inner& inner) {
  LocalPath path;
  path.count = static_cast<int>(inner.end - inner.begin);
  path.diffuse = inner.diffuse;
  path.image = inner.image;
  path.first_material = 0;
  path.last_material = path.count - 1;
  return path;
}

void ChainInner::find(const ChainPlan& plan, const PosedPoints& points) {
  begins_specular.assign(plan.inner.size(), 0);
  is_single.assign(plan.inner.size(), 0);
  rows.resize(plan.inner.size(), InnerRows::kNumRows, points.rows.num_nodes());
  std::array<PosedHit, 64> hits;  // a path has no more
  for (size_t id = 0; id < plan.inner.size(); ++id) {
    const ChainPlan::Inner& inner = plan.inner[id];
    const LocalPath path = path_of(inner);
    for (size_t node = 0; node < rows.num_nodes(); ++node) {
      for (size_t k = inner.begin; k < inner.end; ++k) hits[k - inner.begin] = points.at(plan.inner_points[k], node);
      const InnerPart part = inner_part(path, hits.data());
      const auto set = [&](size_t row, double value) { rows.row(id, row)[node] = value; };
      set(InnerRows::kLength, part.length);
      if (path.diffuse == 0) {
        store(part.last_arrival, rows, id, InnerRows::kArrival, node);
        continue;
      }
      const DiffuseInner found = diffuse_inner(path, hits.data(), part);
      begins_specular[id] = found.begins_specular;
      is_single[id] = found.is_single;
      set(InnerRows::kToFirst, found.to_first);
      set(InnerRows::kRootCosFirst, found.root_cos_first);
      set(InnerRows::kFactor, found.factor);
      set(InnerRows::kFirstSign, found.first_sign);
      set(InnerRows::kLastSign, found.last_sign);
    }
    pad(rows, id, InnerRows::kNumRows);
  }
}

void ChainTables::find(const ChainPlan& plan, const Localiser& localise, const LevelView& level) {
  points.find(plan, localise, level);
  find_mirrors(plan, localise, level, mirrors);
  for (const bool of_receivers : {false, true}) images[of_receivers].find(plan, mirrors, level, of_receivers);
  legs.find(plan, points, images[false], images[true]);
  inner.find(plan, points);
  if (needs_polarizations(localise.paths(), level)) polarizations.find(plan, *this, level);
}

size_t ChainTables::num_bytes() const {
  return points.rows.num_bytes() + mirrors.num_bytes() + images[0].rows.num_bytes() + images[1].rows.num_bytes() +
         legs.rows.num_bytes() + inner.rows.num_bytes() + polarizations.axes.num_bytes() + polarizations.rows.num_bytes();
}

}  // namespace echopath
