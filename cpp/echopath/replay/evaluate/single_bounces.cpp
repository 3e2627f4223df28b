#include "echopath/replay/evaluate/single_bounces.h"

#include <algorithm>
#include <cmath>

#include "echopath/replay/factors/path_weight.h"

namespace echopath {
namespace {

void copy_matrix(const Mat3& matrix, double* to) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) to[3 * row + column] = matrix(row, column);
  }
}

void set_vector(const Vec3& vector, size_t slot, SingleBounceSlots::Row* rows) {
  for (int axis = 0; axis < 3; ++axis) rows[axis][slot] = vector[axis];
}

void set_triangle(const Hit& hit, const Mesh& mesh, size_t slot, SingleBounceSlots& slots) {
  const Triangle& triangle = mesh.triangles()[hit.triangle_id];
  const std::vector<Vec3>& vertices = mesh.vertices();
  const Vec3& corner = vertices[triangle[0]];
  set_vector(corner, slot, slots.corner);
  set_vector(vertices[triangle[1]] - corner, slot, slots.edge[0]);
  set_vector(vertices[triangle[2]] - corner, slot, slots.edge[1]);
  slots.along_edge[0][slot] = hit.u;
  slots.along_edge[1][slot] = hit.v;
}

}  // namespace

bool can_evaluate_single_bounces(const Radar& radar) {
  const auto is_power = [](const Antenna& antenna) { return exponent_of(antenna.pattern) != LegToMeasure::kNoExponent; };
  return std::ranges::all_of(radar.transmitters, is_power) && std::ranges::all_of(radar.receivers, is_power);
}

void SingleBounceEvaluation::operator()(const SharedLegPlan& plan, const PathPreparer& preparer, const PosedNodes& nodes,
                                        const RadioConstants& radio, const ChannelSpan& channels, const Wanted& wanted) {
  if (plan.single_bounces.empty()) return;
  sort_by_mesh(plan);
  begin(preparer, nodes, radio, channels);
  const SingleBounceKernels& kernels = single_bounce_kernels(work_.stride);
  for (size_t first = 0; first < sorted_.size();) {
    const Points points = next_points(first);
    const uint32_t mesh_id = points.front()->hit->mesh_id;
    if (first == 0 || sorted_[first - 1]->hit->mesh_id != mesh_id) enter_mesh(mesh_id, preparer, nodes);
    set_slots(points, preparer);
    kernels.prepare(trace_, slots_);
    work_.has_coherent &= wanted.with_amplitudes;
    kernels.evaluate(work_);
    put_all(points, channels, wanted);
    first += points.size();
  }
}

// Sets what all points share.
void SingleBounceEvaluation::begin(const PathPreparer& preparer, const PosedNodes& nodes, const RadioConstants& radio,
                                   const ChannelSpan& channels) {
  set_antennas(nodes);
  scale_[SingleBounceSlots::kCoherent] = radio.coherent_scale();
  scale_[SingleBounceSlots::kDiffuse] = radio.diffuse_scale();
  const size_t num_nodes = nodes.size();
  out_.resize(channels.nodes.size() * num_nodes * kOfNode);
  const size_t num_legs = SingleBouncesToEvaluate::kNodesTogether * (antennas_[0].size() + antennas_[1].size());
  legs_.resize(num_legs * SingleBouncesToEvaluate::kNumLegRows * kSlots);
  double* axes = nullptr;  // of the world, as seen from the mesh, where polarisations need them
  if (SharedLegTables::needs_polarizations(preparer.paths(), nodes)) {
    axes_.resize(1, ComponentsToFind::kNumAxisRows, num_nodes);
    axes = axes_.row(0, 0);
  }
  const Vec3 recorded_transmitter = mean_antenna_at_trace(preparer.paths(), false),
             recorded_receiver = mean_antenna_at_trace(preparer.paths(), true);
  work_ = {&slots_,
           false,
           {antennas_[0].data(), antennas_[1].data()},
           {antennas_[0].size(), antennas_[1].size()},
           is_monostatic(nodes) && (!axes || recorded_receiver == recorded_transmitter),
           channels.first,
           channels.nodes.size(),
           num_nodes,
           nodes.meshes.stride(),
           radio.filter(),
           kNoFacets,
           axes,
           {{recorded_transmitter.x(), recorded_transmitter.y(), recorded_transmitter.z()},
            {recorded_receiver.x(), recorded_receiver.y(), recorded_receiver.z()}},
           legs_.data(),
           out_.data(),
           turned_,
           radio.mirror_scale(),
           unfiltered_};
}

// Returns the points from `first` on that are evaluated together: those of one mesh, as many as there are slots.
SingleBounceEvaluation::Points SingleBounceEvaluation::next_points(size_t first) const {
  size_t count = 1;
  while (count < kSlots && first + count < sorted_.size() &&
         sorted_[first + count]->hit->mesh_id == sorted_[first]->hit->mesh_id)
    ++count;
  return {sorted_.data() + first, count};
}

void SingleBounceEvaluation::enter_mesh(uint32_t mesh_id, const PathPreparer& preparer, const PosedNodes& nodes) {
  set_mesh(mesh_id, preparer);
  work_.facet_area = preparer.facet_area(mesh_id);
  see_antennas(mesh_id, preparer, nodes);
  if (work_.axes) see_axes(mesh_id, preparer, nodes);
}

void SingleBounceEvaluation::put_all(Points points, const ChannelSpan& channels, const Wanted& wanted) const {
  const double* values = out_.data();
  for (const ChannelNodes& to : channels.nodes) {
    put(points, to, values);
    values += work_.num_nodes * kOfNode;
  }
  if (wanted.turned) mark_turned(points, wanted.turned);
  if (wanted.unfiltered) mark_unfiltered(points, wanted.unfiltered);
}

void SingleBounceEvaluation::sort_by_mesh(const SharedLegPlan& plan) {
  first_of_mesh_.clear();
  for (const SharedLegPlan::SingleBounce& one : plan.single_bounces) {
    const size_t mesh = one.hit->mesh_id;
    if (mesh + 2 > first_of_mesh_.size()) first_of_mesh_.resize(mesh + 2);
    ++first_of_mesh_[mesh + 1];
  }
  for (size_t mesh = 1; mesh < first_of_mesh_.size(); ++mesh) first_of_mesh_[mesh] += first_of_mesh_[mesh - 1];
  sorted_.resize(plan.single_bounces.size());
  for (const SharedLegPlan::SingleBounce& one : plan.single_bounces) sorted_[first_of_mesh_[one.hit->mesh_id]++] = &one;
}

void SingleBounceEvaluation::set_antennas(const PosedNodes& nodes) {
  for (const bool of_receivers : {false, true}) {
    const std::vector<PosedAntenna>& posed = nodes.at(0).antennas(of_receivers);
    seen_[of_receivers].resize(posed.size(), LegToMeasure::kNumImageRows, nodes.size());
    antennas_[of_receivers].clear();
    for (const PosedAntenna& one : posed) {
      const size_t antenna = antennas_[of_receivers].size();
      const double *rows = seen_[of_receivers].row(antenna, 0), *own = nodes.polarizations[of_receivers].row(antenna, 0);
      antennas_[of_receivers].push_back({rows, own, exponent_of(*one.pattern), std::sqrt(one.pattern->peak_gain)});
    }
  }
}

bool SingleBounceEvaluation::is_monostatic(const PosedNodes& nodes) const {
  if (antennas_[0].size() != antennas_[1].size()) return false;
  const NodeRows &transmitters = nodes.antennas[0], &receivers = nodes.antennas[1];
  for (size_t i = 0; i < antennas_[0].size(); ++i) {
    if (antennas_[0][i].exponent != antennas_[1][i].exponent || antennas_[0][i].root_peak != antennas_[1][i].root_peak)
      return false;
    const double* rows = transmitters.row(i, 0);
    if (!std::equal(rows, rows + LegToMeasure::kNumImageRows * transmitters.stride(), receivers.row(i, 0))) return false;
    const NodeRows* own = nodes.polarizations;
    const size_t count = ComponentsToFind::kNumPolarizationRows * own[0].stride();
    if (!std::equal(own[0].row(i, 0), own[0].row(i, 0) + count, own[1].row(i, 0))) return false;
  }
  return true;
}

// A mesh that stands still sees the antennas where they are in the world: they are copied, so that the scale of the mesh
// adds no rounding.
void SingleBounceEvaluation::see_antennas(uint32_t mesh_id, const PathPreparer& preparer, const PosedNodes& nodes) {
  const bool is_still = !preparer.paths().scene->is_moving(mesh_id);
  for (const bool of_receivers : {false, true}) {
    NodeRows& seen = seen_[of_receivers];
    for (size_t antenna = 0; antenna < antennas_[of_receivers].size(); ++antenna) {
      const double* const in_world = nodes.antennas[of_receivers].row(antenna, 0);
      double* const out = seen.row(antenna, 0);
      if (is_still) std::copy_n(in_world, LegToMeasure::kNumImageRows * seen.stride(), out);
      else single_bounce_kernels(seen.stride()).see(trace_, {nodes.meshes.row(mesh_id, 0), in_world, out}, seen.stride());
    }
  }
}

// Undoes the rotation of the mesh since the trace, as `see_antennas` does.
void SingleBounceEvaluation::see_axes(uint32_t mesh_id, const PathPreparer& preparer, const PosedNodes& nodes) {
  const bool is_still = !preparer.paths().scene->is_moving(mesh_id);
  for (size_t node = 0; node < axes_.num_nodes(); ++node) {
    Mat3 world_from_seen = Mat3::Identity();
    if (!is_still) world_from_seen = nodes.at(node).linear(mesh_id) * preparer.mesh_from_trace(mesh_id);
    for (int axis = 0; axis < 3; ++axis) {
      const size_t row = ComponentsToFind::kAxes + 3 * static_cast<size_t>(axis);
      store(world_from_seen.row(axis), axes_, 0, row, node);
    }
  }
  pad(axes_, 0, ComponentsToFind::kNumAxisRows);
}

void SingleBounceEvaluation::set_mesh(uint32_t mesh_id, const PathPreparer& preparer) {
  const PosedScene& trace = preparer.at_trace();
  copy_matrix(trace.linear(mesh_id), trace_.linear);
  copy_matrix(trace.normal_matrix(mesh_id), trace_.normal);
  copy_matrix(preparer.mesh_from_trace(mesh_id), trace_.mesh_from_trace);
  std::copy_n(trace.translation(mesh_id).data(), 3, trace_.translation);
}

// Slots behind the last point repeat the last point.
void SingleBounceEvaluation::set_slots(Points points, const PathPreparer& preparer) {
  const Paths& paths = preparer.paths();
  const Mesh& mesh = *paths.scene->node_of(points.front()->hit->mesh_id).mesh;
  work_.has_coherent = false;
  for (size_t slot = 0; slot < kSlots; ++slot) {
    const SharedLegPlan::SingleBounce& point = *points[std::min(slot, points.size() - 1)];
    set_triangle(*point.hit, mesh, slot, slots_);
    set_weights(point, slot, paths);
    const int64_t coherent = point.path[SingleBounceSlots::kCoherent];
    const bool is_coherent = coherent != SharedLegPlan::SingleBounce::kNoPath;
    work_.has_coherent |= is_coherent;
    slots_.density[slot] = is_coherent ? paths.frame.lattice_density(paths.stratum[coherent]) : 0.0;
  }
}

// Polarised paths between upright antennas need only one entry of their matrix.
void SingleBounceEvaluation::set_weights(const SharedLegPlan::SingleBounce& point, size_t slot, const Paths& paths) {
  for (size_t kind = 0; kind < SingleBounceSlots::kNumKinds; ++kind) {
    const bool is_there = point.has_path(kind);
    const auto path = static_cast<size_t>(is_there ? point.path[kind] : 0);
    const std::complex<double> weight = is_there ? scale_[kind] * weight_of(paths, path) : 0.0;
    const auto set = [&](SingleBounceSlots::Row* rows, std::complex<double> value) {
      rows[0][slot] = value.real();
      rows[1][slot] = value.imag();
    };
    if (paths.jones.empty()) {
      set(slots_.weight[kind], weight);
    } else if (!work_.axes) {
      set(slots_.weight[kind], weight * std::complex<double>(paths.jones[path][3]));
    } else {
      for (size_t entry = 0; entry < 4; ++entry) {
        set(slots_.matrix[kind][entry], weight * std::complex<double>(paths.jones[path][entry]));
      }
    }
  }
}

void SingleBounceEvaluation::mark_turned(Points points, uint8_t* turned) const {
  for (size_t slot = 0; slot < points.size(); ++slot) {
    for (size_t kind = 0; kind < SingleBounceSlots::kNumKinds; ++kind) {
      if (points[slot]->has_path(kind)) turned[points[slot]->place[kind]] = work_.turned[slot] != 0.0;
    }
  }
}

void SingleBounceEvaluation::mark_unfiltered(Points points, double* unfiltered) const {
  constexpr auto kKind = SingleBounceSlots::kCoherent;
  for (size_t slot = 0; slot < points.size(); ++slot) {
    if (points[slot]->has_path(kKind)) unfiltered[points[slot]->place[kKind]] = unfiltered_[slot];
  }
}

}  // namespace echopath
