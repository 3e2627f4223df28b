#include "echopath/replay/evaluate/shared_leg_tables.h"

#include <algorithm>

#include "echopath/base/plane.h"
#include "echopath/replay/evaluate/inner_part.h"

namespace echopath {
namespace {

void find_mirrors(const SharedLegPlan& plan, const PathPreparer& preparer, const PosedNodes& nodes, NodeRows& planes) {
  planes.resize(plan.mirrors.size(), 4, nodes.size());
  std::deque<std::array<Vec3, 3>> normals;
  for (size_t mirror = 0; mirror < plan.mirrors.size(); ++mirror) {
    const LocalHit local = preparer.hit(plan.mirrors[mirror], normals);
    for (size_t node = 0; node < nodes.size(); ++node) {
      PosedHit posed;
      pose_hit(local, nodes.at(node), false, posed);
      store(posed.normal, planes, mirror, 0, node);
      planes.row(mirror, 3)[node] = posed.normal.dot(posed.point);
    }
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

void PosedPoints::find(const SharedLegPlan& plan, const PathPreparer& preparer, const PosedNodes& nodes) {
  rows.resize(plan.points.size(), PointToPose::kNumRows, nodes.size());
  traced.resize(plan.points.size());
  normals.clear();
  curvatures.clear();
  for (size_t point = 0; point < plan.points.size(); ++point) {
    const LocalHit hit = preparer.hit(plan.points[point], normals);
    if (preparer.may_stretch(hit.mesh_id)) pose_stretched(hit, preparer, nodes, point);
    else pose_rigid(hit, preparer, nodes, point);
  }
}

// A smooth surface is smooth in the frame of its mesh: the point off its facet and the normal there move as any other.
void PosedPoints::pose_rigid(const LocalHit& hit, const PathPreparer& preparer, const PosedNodes& nodes, size_t point) {
  const PosedScene& trace = preparer.at_trace();
  const Mat3& mesh_from_trace = preparer.mesh_from_trace(hit.mesh_id);
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
  to.mesh = nodes.meshes.row(hit.mesh_id, 0);
  std::copy_n(position.data(), 3, to.position);
  std::copy_n(normal.data(), 3, to.normal);
  to.out = rows.row(point, 0);
  shared_leg_kernels(rows.stride()).pose(to, rows.stride());
}

void PosedPoints::pose_stretched(const LocalHit& hit, const PathPreparer& preparer, const PosedNodes& nodes, size_t point) {
  PosedHit posed;
  pose_hit(hit, preparer.at_trace(), false, posed);
  traced[point] = {posed.point, posed.normal, nullptr};
  for (size_t node = 0; node < nodes.size(); ++node) {
    pose_hit(hit, nodes.at(node), false, posed);
    store(posed.point, rows, point, PointToPose::kPosition, node);
    store(posed.normal, rows, point, PointToPose::kNormal, node);
    rows.row(point, PointToPose::kAreaRatio)[node] = posed.area_ratio;
  }
  pad(rows, point, PointToPose::kNumRows);
}

Vec3 mean_antenna_at_trace(const Paths& paths, bool of_receivers) {
  return of_receivers ? Vec3(paths.frame.receiver - paths.frame.transmitter) : Vec3(Vec3::Zero());
}

AxesAcross<double> ImageAtTrace::axes_toward(const Vec3& point, const Vec3& antenna) const {
  const Vec3 line = linear.transpose() * (point - of(antenna));
  return axes_across<ScalarMath>(VectorOf<double>{line.x(), line.y(), line.z()});
}

std::vector<ImageAtTrace> images_at_trace(const SharedLegPlan& plan, const PathPreparer& preparer) {
  std::vector<ImageAtTrace> images(1);
  std::deque<std::array<Vec3, 3>> normals;
  for (size_t image = 1; image < plan.images.size(); ++image) {
    const ImageAtTrace& parent = images[plan.images[image].parent];
    PosedHit mirror;
    pose_hit(preparer.hit(plan.mirrors[plan.images[image].mirror], normals), preparer.at_trace(), false, mirror);
    const Mat3 linear = reflection(mirror.normal) * parent.linear;
    images.push_back({linear, mirror.image(parent.translation)});
  }
  return images;
}

void LegTable::resize(size_t num_legs, size_t num_nodes, bool with_phases, bool with_components) {
  has_phases = with_phases;
  has_components = with_components;
  rows.resize(num_legs, LegToMeasure::kNumRows, num_nodes);
  if (with_phases) phases.resize(num_legs, 1, num_nodes);
  if (with_components) components.resize(num_legs, ComponentsToFind::kNumRows, num_nodes);
}

LocalPath path_of(const SharedLegPlan::Inner& inner) {
  LocalPath path;
  path.count = static_cast<int>(inner.end - inner.begin);
  path.diffuse = inner.diffuse;
  path.image = inner.image;
  path.first_material = 0;
  path.last_material = path.count - 1;
  return path;
}

namespace {

// Stores the inner part of a path whose hits are posed at a node.
DiffuseInner store_inner(const LocalPath& path, const PosedHit* hits, size_t entry, size_t node, NodeRows& rows) {
  const InnerPart part = inner_part(path, hits);
  const auto set = [&](size_t row, double value) { rows.row(entry, row)[node] = value; };
  set(InnerRows::kLength, part.length);
  if (path.diffuse == 0) {
    store(part.last_arrival, rows, entry, InnerRows::kArrival, node);
    return {};
  }
  const DiffuseInner found = diffuse_inner(path, hits, part);
  set(InnerRows::kToFirst, found.to_first);
  set(InnerRows::kRootCosFirst, found.root_cos_first);
  set(InnerRows::kFactor, found.factor);
  set(InnerRows::kFirstSign, found.first_sign);
  set(InnerRows::kLastSign, found.last_sign);
  return found;
}

}  // namespace

void InnerPartTable::find(const SharedLegPlan& plan, const PosedPoints& points) {
  begins_specular.assign(plan.inner.size(), 0);
  is_single.assign(plan.inner.size(), 0);
  rows.resize(plan.inner.size(), InnerRows::kNumRows, points.rows.num_nodes());
  std::array<PosedHit, 64> hits;  // a path has no more
  for (size_t id = 0; id < plan.inner.size(); ++id) {
    const SharedLegPlan::Inner& inner = plan.inner[id];
    const LocalPath path = path_of(inner);
    for (size_t node = 0; node < rows.num_nodes(); ++node) {
      for (size_t k = inner.begin; k < inner.end; ++k) hits[k - inner.begin] = points.at(plan.inner_points[k], node);
      const DiffuseInner found = store_inner(path, hits.data(), id, node, rows);
      begins_specular[id] = found.begins_specular;
      is_single[id] = found.is_single;
    }
    pad(rows, id, InnerRows::kNumRows);
  }
}

void SlidingParts::find(const SharedLegPlan& plan, const PathPreparer& preparer, const PosedNodes& nodes, size_t stride) {
  if (plan.sliding.empty()) return;
  const LocalPaths local = preparer(plan.sliding);
  const size_t num_entries = plan.sliding.size() * stride, num_nodes = nodes.size();
  points.resize(num_entries, PointToPose::kNumRows, num_nodes);
  inner.resize(num_entries, InnerRows::kNumRows, num_nodes);
  for (size_t slide = 0; slide < local.paths.size(); ++slide) move_points(local.paths[slide], slide * stride, nodes);
}

void SlidingParts::move_points(const LocalPath& path, size_t first_entry, const PosedNodes& nodes) {
  const size_t num_starts = nodes.at(0).antennas(path.is_reversed).size();
  std::array<PosedHit, 64> recorded, moved;  // a path has no more
  SpecularSlide scratch;
  for (size_t node = 0; node < nodes.size(); ++node) {
    pose_hits(path, nodes.at(node), recorded.data());
    const std::vector<PosedAntenna>& starts = nodes.at(node).antennas(path.is_reversed);
    for (size_t antenna = 0; antenna < num_starts; ++antenna) {
      const size_t entry = first_entry + antenna;
      std::copy_n(recorded.begin(), path.count, moved.begin());
      step_to_fermat(path, starts[antenna].position, scratch, moved.data());
      const PosedHit& first = moved[path.first_material];
      store(first.point, points, entry, PointToPose::kPosition, node);
      store(first.normal, points, entry, PointToPose::kNormal, node);
      points.row(entry, PointToPose::kAreaRatio)[node] = first.area_ratio;
      store_inner(path, moved.data(), entry, node, inner);
    }
  }
  for (size_t entry = first_entry; entry < first_entry + num_starts; ++entry) {
    pad(points, entry, PointToPose::kNumRows);
    pad(inner, entry, InnerRows::kNumRows);
  }
}

namespace {

// Returns whether an antenna turns the phase of what it sends or receives, by direction.
bool any_phase(const AntennaImages& images) {
  return std::ranges::any_of(
      images.pattern, [](const AntennaPattern* pattern) { return pattern->table && !pattern->table->phase().empty(); });
}

// Finds the axes of the world as the antennas themselves see them and as each image sees them over its mirrors.
void find_axes(const SharedLegPlan& plan, const NodeRows& mirrors, NodeRows& axes) {
  axes.resize(plan.images.size(), ComponentsToFind::kNumAxisRows, mirrors.num_nodes());
  for (size_t image = 0; image < plan.images.size(); ++image) {
    for (int axis = 0; axis < 3; ++axis) {
      const size_t row = ComponentsToFind::kAxes + 3 * static_cast<size_t>(axis);
      for (size_t node = 0; node < axes.num_nodes(); ++node) {
        Vec3 seen = Vec3::Unit(axis);
        if (image > 0) {
          const Vec3 normal = load(mirrors, plan.images[image].mirror, 0, node);
          seen = mirrored(load(axes, plan.images[image].parent, row, node), normal);
        }
        store(seen, axes, image, row, node);
      }
    }
    pad(axes, image, ComponentsToFind::kNumAxisRows);
  }
}

}  // namespace

void SharedLegTables::find(const SharedLegPlan& plan, const PathPreparer& preparer, const PosedNodes& nodes) {
  points.find(plan, preparer, nodes);
  find_mirrors(plan, preparer, nodes, mirrors);
  for (const bool of_receivers : {false, true}) images[of_receivers].find(plan, mirrors, nodes, of_receivers);
  stride = std::max(images[0].num_antennas, images[1].num_antennas);
  has_phases = any_phase(images[0]) || any_phase(images[1]);
  has_polarizations = needs_polarizations(preparer.paths(), nodes);
  const bool of_mirrors = !preparer.paths().jones.empty() && !plan.mirror_paths.empty();
  if (has_polarizations || of_mirrors) {
    find_axes(plan, mirrors, axes);
    traced_images = images_at_trace(plan, preparer);
  }
  if (has_polarizations) find_leg_axes(plan, preparer.paths());
  inner.find(plan, points);
  sliding.find(plan, preparer, nodes, stride);
  measure_legs(plan, nodes);
}

void SharedLegTables::find_leg_axes(const SharedLegPlan& plan, const Paths& paths) {
  const Vec3 antenna[] = {mean_antenna_at_trace(paths, false), mean_antenna_at_trace(paths, true)};
  leg_axes.resize(plan.legs.size());
  for (size_t id = 0; id < plan.legs.size(); ++id) {
    const SharedLegPlan::Leg& leg = plan.legs[id];
    leg_axes[id] = traced_images[leg.image].axes_toward(points.traced[leg.point].position, antenna[leg.of_receivers]);
  }
}

void SharedLegTables::measure_legs(const SharedLegPlan& plan, const PosedNodes& nodes) {
  const size_t num_nodes = nodes.size();
  legs.resize(plan.legs.size() * stride, num_nodes, has_phases, has_polarizations);
  for (size_t id = 0; id < plan.legs.size(); ++id) {
    const auto& [image, point, of_receivers] = plan.legs[id];
    for (size_t antenna = 0; antenna < images[of_receivers].num_antennas; ++antenna) {
      measure({of_receivers, image, antenna, axes_of(static_cast<uint32_t>(id))}, points.rows.row(point, 0), nodes,
              id * stride + antenna, legs);
    }
  }
  sliding.legs.resize(plan.sliding.size() * stride, num_nodes, has_phases, has_polarizations);
  for (const SharedLegPlan::ChainPath& chain : plan.chains) {
    if (chain.slide == SharedLegPlan::kNone) continue;
    for (size_t antenna = 0; antenna < images[chain.is_reversed].num_antennas; ++antenna) {
      const size_t entry = chain.slide * stride + antenna;
      measure({chain.is_reversed, plan.legs[chain.start].image, antenna, axes_of(chain.start)}, sliding.points.row(entry, 0),
              nodes, entry, sliding.legs);
    }
  }
}

void SharedLegTables::measure(const ImageOfAntenna& from, const double* point, const PosedNodes& nodes, size_t leg,
                              LegTable& to) const {
  const AntennaImages& seen = images[from.of_receivers];
  const size_t entry = seen.entry(from.image, from.antenna);
  seen.measure(entry, point, to.rows.row(leg, 0), to.has_phases ? to.phases.row(leg, 0) : nullptr);
  if (!to.has_components) return;
  const double* own = nodes.polarizations[from.of_receivers].row(from.antenna, 0);
  shared_leg_kernels(axes.stride())
      .find_components(
          {seen.rows.row(entry, 0), axes.row(from.image, 0), own, point, *from.recorded, to.components.row(leg, 0)},
          axes.stride());
}

size_t SharedLegTables::num_bytes() const {
  size_t bytes = points.rows.num_bytes() + mirrors.num_bytes() + axes.num_bytes() + legs.num_bytes() +
                 inner.rows.num_bytes() + sliding.points.num_bytes() + sliding.legs.num_bytes() + sliding.inner.num_bytes();
  for (const AntennaImages& of_end : images)
    bytes += of_end.rows.num_bytes() + of_end.antenna_from_image.capacity() * sizeof(Mat3);
  return bytes;
}

}  // namespace echopath
