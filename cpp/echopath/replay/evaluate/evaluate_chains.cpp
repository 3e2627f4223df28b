#include "echopath/replay/evaluate/evaluate_chains.h"

#include <algorithm>
#include <cmath>

namespace echopath {
namespace {

void set_cell(const PlacedCell& cell, CoherentPath& path) {
  path.cell = cell.shape;
  path.root_area = cell.root_area;
  for (int a = 0; a < 2; ++a) std::copy_n(cell.tangent[a].data(), 3, path.tangent[a]);
}

// Sets a mesh whose frame is that of the world: the tangents of stretching cells stand in it.
void set_world(size_t num_nodes, NodeRows& world) {
  world.resize(1, PointToPose::kNumMeshRows, num_nodes);
  for (size_t row = 0; row < PointToPose::kNumMeshRows; ++row) {
    const bool is_diagonal = row < PointToPose::kTranslation && row % 4 == 0;
    std::fill_n(world.row(0, row), world.stride(), is_diagonal ? 1.0 : 0.0);
  }
}

}  // namespace

void ChainEvaluation::operator()(const ChainPlan& plan, const PathPreparer& preparer, const PosedNodes& nodes, const RadioConstants& radio,
                                 const ChannelSpan& channels) {
  if (plan.chains.empty() && plan.mirror_paths.empty()) return;
  num_receivers_ = nodes.at(0).receivers.size();
  paths_ = &preparer.paths();
  tables_.find(plan, preparer, nodes);
  values_.resize(kTogether, PathToCombine::kNumRows, nodes.size());
  kernels_ = &chain_kernels(values_.stride());
  set_world(nodes.size(), world_);
  const TraceCells cells(plan, preparer, tables_.points);
  const double of_coherent = radio.coherent_scale(), of_diffuse = radio.diffuse_scale();
  for (CoherentPath& path : coherent_) path.filter = radio.filter();
  for (size_t first = 0; first < plan.chains.size(); first += kTogether) {
    const Chains chains(plan.chains.data() + first, std::min(kTogether, plan.chains.size() - first));
    for (size_t slot = 0; slot < chains.size(); ++slot) {
      if (chains[slot].is_coherent) place_cell(plan, chains[slot], cells, nodes, slot);
    }
    for (size_t channel = 0; channel < channels.nodes.size(); ++channel) {
      for (size_t slot = 0; slot < chains.size(); ++slot) {
        const ChainPlan::Chain& chain = chains[slot];
        const Ends ends = ends_of(chain, channels.first + channel);
        if (chain.is_coherent) evaluate_coherent(plan, chain, ends, of_coherent, slot);
        else evaluate_diffuse(chain, ends, of_diffuse, slot);
        turn(chain.path, start_of(chain, ends.start), end_of(chain, ends.end), slot);
      }
      put(chains, channels.nodes[channel]);
    }
  }
  for (const ChainPlan::MirrorPath& path : plan.mirror_paths) evaluate_mirrors(path, nodes, channels, radio.mirror_scale());
}

ChainEvaluation::Ends ChainEvaluation::ends_of(const ChainPlan::Chain& chain, size_t channel) const {
  const size_t transmitter = channel / num_receivers_, receiver = channel % num_receivers_;
  return chain.is_reversed ? Ends{receiver, transmitter} : Ends{transmitter, receiver};
}

// Between upright antennas only one entry of the matrix counts.
ComplexOf<double> ChainEvaluation::scaled_weight(const ChainPlan::Chain& chain, double scale) const {
  std::complex<double> weight = scale * chain.weight;
  if (!paths_->jones.empty() && !tables_.has_polarizations) {
    weight *= std::complex<double>(paths_->jones[static_cast<size_t>(chain.path)][3]);
  }
  return {weight.real(), weight.imag()};
}

ChainEvaluation::MeasuredLeg ChainEvaluation::start_of(const ChainPlan::Chain& chain, size_t antenna) const {
  if (chain.slide != ChainPlan::kNone) return {tables_.sliding.legs, chain.slide * tables_.stride + antenna};
  return {tables_.legs, chain.start * tables_.stride + antenna};
}

ChainEvaluation::MeasuredLeg ChainEvaluation::end_of(const ChainPlan::Chain& chain, size_t antenna) const {
  return {tables_.legs, chain.end * tables_.stride + antenna};
}

// `antenna` is the antenna at the start. The result is null where there is one material point.
const double* ChainEvaluation::inner_of(const ChainPlan::Chain& chain, size_t antenna) const {
  if (chain.slide != ChainPlan::kNone) return tables_.sliding.inner.row(chain.slide * tables_.stride + antenna, 0);
  return chain.inner == ChainPlan::kNone ? nullptr : tables_.inner.rows.row(chain.inner, 0);
}

PathToCombine ChainEvaluation::path_of(const ChainPlan::Chain& chain, const Ends& ends, double scale, size_t slot) {
  return {start_of(chain, ends.start).rows(), end_of(chain, ends.end).rows(), inner_of(chain, ends.start),
          scaled_weight(chain, scale), values_.row(slot, 0)};
}

const double* ChainEvaluation::image_of(const ChainPlan& plan, uint32_t leg, size_t antenna) const {
  const AntennaImages& images = tables_.images[plan.legs[leg].of_receivers];
  return images.rows.row(images.entry(plan.legs[leg].image, antenna), 0);
}

void ChainEvaluation::place_cell(const ChainPlan& plan, const ChainPlan::Chain& chain, const TraceCells& cells,
                                 const PosedNodes& nodes, size_t slot) {
  const uint32_t point = plan.legs[chain.end].point, mesh_id = plan.points[point].mesh_id;
  CoherentPath& path = coherent_[slot];
  path.point = tables_.points.rows.row(point, 0);
  stretching_[slot].clear();
  if (cells.may_stretch(mesh_id)) {
    path.mesh = world_.row(0, 0);
    stretching_[slot] = cells.on_stretching(chain, nodes);
  } else {
    path.mesh = nodes.meshes.row(mesh_id, 0);
    set_cell(cells.on_rigid(chain), path);
  }
}

void ChainEvaluation::evaluate_coherent(const ChainPlan& plan, const ChainPlan::Chain& chain, const Ends& ends, double scale,
                                        size_t slot) {
  CoherentPath& path = coherent_[slot];
  path.path = path_of(chain, ends, scale, slot);
  path.start_image = image_of(plan, chain.start, ends.start);
  path.end_image = image_of(plan, chain.end, ends.end);
  if (stretching_[slot].empty()) kernels_->reflect(path, 0, values_.stride(), values_.stride());
  else reflect_from_stretching(slot);
}

// Cells differ from node to node, and so does the area for which the ray stands.
void ChainEvaluation::reflect_from_stretching(size_t slot) {
  CoherentPath path = coherent_[slot];
  const ComplexOf<double> weight = path.path.weight;
  for (size_t node = 0; node < values_.num_nodes(); ++node) {
    set_cell(stretching_[slot][node], path);
    const double area_ratio = path.point[PointToPose::kAreaRatio * values_.stride() + node];
    path.path.weight = {area_ratio * weight.re, area_ratio * weight.im};
    chain_kernels_of_one().reflect(path, node, node + 1, values_.stride());
  }
}

void ChainEvaluation::evaluate_diffuse(const ChainPlan::Chain& chain, const Ends& ends, double scale, size_t slot) {
  const bool has_inner = chain.inner != ChainPlan::kNone;
  const bool begins_specular = has_inner && tables_.inner.begins_specular[chain.inner];
  const bool is_single = !has_inner || tables_.inner.is_single[chain.inner];
  kernels_->combine({path_of(chain, ends, scale, slot), begins_specular, is_single}, values_.stride());
}

// Applies the polarisations and phases of the antennas at both ends, where its legs hold them, to a path.
void ChainEvaluation::turn(int64_t path, const MeasuredLeg& start, const MeasuredLeg& end, size_t slot) {
  if (start.table.has_components) polarize(path, start, end, slot);
  if (start.table.has_phases) turn_phase(start, end, slot);
}

void ChainEvaluation::polarize(int64_t path, const MeasuredLeg& start, const MeasuredLeg& end, size_t slot) {
  PathToPolarize work{start.table.components.row(start.leg, 0), end.table.components.row(end.leg, 0), {}, {}, values_.row(slot, 0)};
  const JonesMatrix& matrix = paths_->jones[static_cast<size_t>(path)];
  for (size_t entry = 0; entry < matrix.size(); ++entry) {
    work.re[entry] = matrix[entry].real();
    work.im[entry] = matrix[entry].imag();
  }
  kernels_->polarize(work, values_.stride());
}

void ChainEvaluation::turn_phase(const MeasuredLeg& start, const MeasuredLeg& end, size_t slot) {
  const double *first = start.table.phases.row(start.leg, 0), *last = end.table.phases.row(end.leg, 0);
  double *re = values_.row(slot, PathToCombine::kRe), *im = values_.row(slot, PathToCombine::kIm);
  for (size_t node = 0; node < values_.num_nodes(); ++node) {
    const std::complex<double> turned = std::complex(re[node], im[node]) * std::polar(1.0, first[node] + last[node]);
    re[node] = turned.real();
    im[node] = turned.imag();
  }
}

// Each end sees the other over the mirrors: one leg leads from the transmitter's image to the receiver, and one back.
void ChainEvaluation::evaluate_mirrors(const ChainPlan::MirrorPath& path, const PosedNodes& nodes, const ChannelSpan& channels,
                                       double scale) {
  constexpr size_t kSlot = 0;
  // The components are needed between upright antennas too, because these send nothing straight up or down.
  mirror_legs_.resize(2, nodes.size(), tables_.has_phases, !paths_->jones.empty());
  const MeasuredLeg start{mirror_legs_, 0}, back{mirror_legs_, 1};
  const ComplexOf<double> weight{scale * path.weight.real(), scale * path.weight.imag()};
  for (size_t channel = 0; channel < channels.nodes.size(); ++channel) {
    const size_t of_all = channels.first + channel;
    const ChainTables::ImageOfAntenna ends[] = {{false, path.image, of_all / num_receivers_}, {true, 0, of_all % num_receivers_}};
    for (const size_t end : {0, 1}) {
      const ChainTables::ImageOfAntenna& other = ends[1 - end];
      const AntennaImages& images = tables_.images[other.of_receivers];
      // The position of an antenna stands in the same rows as the position of a point.
      const double* point = images.rows.row(images.entry(other.image, other.antenna), 0);
      tables_.measure(ends[end], point, nodes, end, mirror_legs_);
    }
    kernels_->connect({start.rows(), back.rows(), nullptr, weight, values_.row(kSlot, 0)}, values_.stride());
    turn(path.path, start, back, kSlot);
    put(std::span(&path, 1), channels.nodes[channel]);
  }
}

bool ChainEvaluation::turns(uint32_t leg) const {
  const double* factor = tables_.legs.rows.row(leg * tables_.stride, LegToMeasure::kFactor);
  return std::signbit(factor[0]) != std::signbit(factor[values_.num_nodes() - 1]);
}

void ChainEvaluation::mark_turned(const ChainPlan& plan, uint8_t* turned) const {
  for (const ChainPlan::Chain& chain : plan.chains) turned[chain.place] = turns(chain.start) || turns(chain.end);
}

// Writes the values of some paths to their places, node by node, because neighbours share the lines of the cache.
template <class Path>
void ChainEvaluation::put(std::span<const Path> paths, const ChannelNodes& to) const {
  const double* const values = values_.row(0, 0);
  const size_t stride = values_.stride(), of_slot = PathToCombine::kNumRows * stride;
  for (size_t node = 0; node < values_.num_nodes(); ++node) {
    const double* value = values + node;
    for (const Path& path : paths) {
      to.set(node, path.place, value[PathToCombine::kLength * stride],
             {value[PathToCombine::kRe * stride], value[PathToCombine::kIm * stride]});
      value += of_slot;
    }
  }
}

}  // namespace echopath
