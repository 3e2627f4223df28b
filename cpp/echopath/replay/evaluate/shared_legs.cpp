#include "echopath/replay/evaluate/shared_legs.h"

#include <algorithm>
#include <cmath>

#include "echopath/replay/kernels/path_formula.h"

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

void SharedLegEvaluation::operator()(const SharedLegPlan& plan, const PathPreparer& preparer, const PosedNodes& nodes,
                                     const RadioConstants& radio, const ChannelSpan& channels) {
  if (plan.chains.empty() && plan.mirror_paths.empty()) return;
  prepare(plan, preparer, nodes, radio);
  const TraceCells cells(plan, preparer, tables_.points);
  const double of_coherent = radio.coherent_scale(), of_diffuse = radio.diffuse_scale();
  for (size_t first = 0; first < plan.chains.size(); first += kTogether) {
    const Chains chains(plan.chains.data() + first, std::min(kTogether, plan.chains.size() - first));
    for (size_t slot = 0; slot < chains.size(); ++slot) {
      if (chains[slot].is_coherent) place_cell(plan, first + slot, cells, nodes, slot);
    }
    for (size_t channel = 0; channel < channels.nodes.size(); ++channel) {
      for (size_t slot = 0; slot < chains.size(); ++slot) {
        const SharedLegPlan::ChainPath& chain = chains[slot];
        const Ends ends = ends_of(chain, channels.first + channel);
        if (chain.is_coherent)
          evaluate_coherent(plan, chain, ends, of_coherent, slot, channels.nodes[channel].turn != nullptr);
        else evaluate_diffuse(chain, ends, of_diffuse, slot);
        turn(chain.path, start_of(chain, ends.start), end_of(chain, ends.end), slot);
      }
      put(chains, channels.nodes[channel]);
    }
  }
  for (const SharedLegPlan::MirrorPath& path : plan.mirror_paths)
    evaluate_mirrors(path, nodes, channels, radio.mirror_scale());
}

// Finds what the paths share at these nodes, unless it is known.
void SharedLegEvaluation::prepare(const SharedLegPlan& plan, const PathPreparer& preparer, const PosedNodes& nodes,
                                  const RadioConstants& radio) {
  num_receivers_ = nodes.at(0).receivers.size();
  paths_ = &preparer.paths();
  if (posed_at_ != &nodes) tables_.find(plan, preparer, nodes);
  posed_at_ = &nodes;
  values_.resize(kTogether, PathToCombine::kNumRows, nodes.size());
  kernels_ = &shared_leg_kernels(values_.stride());
  set_world(nodes.size(), world_);
  if (cells_.empty()) find_cells(plan, TraceCells(plan, preparer, tables_.points));
  for (CoherentPath& path : coherent_) path.filter = radio.filter();
}

SharedLegEvaluation::Ends SharedLegEvaluation::ends_of(const SharedLegPlan::ChainPath& chain, size_t channel) const {
  const size_t transmitter = channel / num_receivers_, receiver = channel % num_receivers_;
  return chain.is_reversed ? Ends{receiver, transmitter} : Ends{transmitter, receiver};
}

// Between upright antennas only one entry of the matrix counts.
ComplexOf<double> SharedLegEvaluation::scaled_weight(const SharedLegPlan::ChainPath& chain, double scale) const {
  std::complex<double> weight = scale * chain.weight;
  if (!paths_->jones.empty() && !tables_.has_polarizations) {
    weight *= std::complex<double>(paths_->jones[chain.path][3]);
  }
  return {weight.real(), weight.imag()};
}

SharedLegEvaluation::MeasuredLeg SharedLegEvaluation::start_of(const SharedLegPlan::ChainPath& chain, size_t antenna) const {
  if (chain.slide != SharedLegPlan::kNone) return {tables_.sliding.legs, chain.slide * tables_.stride + antenna};
  return {tables_.legs, chain.start * tables_.stride + antenna};
}

SharedLegEvaluation::MeasuredLeg SharedLegEvaluation::end_of(const SharedLegPlan::ChainPath& chain, size_t antenna) const {
  return {tables_.legs, chain.end * tables_.stride + antenna};
}

// `antenna` is the antenna at the start. The result is null where there is one material point.
const double* SharedLegEvaluation::inner_of(const SharedLegPlan::ChainPath& chain, size_t antenna) const {
  if (chain.slide != SharedLegPlan::kNone) return tables_.sliding.inner.row(chain.slide * tables_.stride + antenna, 0);
  return chain.inner == SharedLegPlan::kNone ? nullptr : tables_.inner.rows.row(chain.inner, 0);
}

PathToCombine SharedLegEvaluation::path_of(const SharedLegPlan::ChainPath& chain, const Ends& ends, double scale,
                                           size_t slot) {
  return {start_of(chain, ends.start).rows(), end_of(chain, ends.end).rows(), inner_of(chain, ends.start),
          scaled_weight(chain, scale), values_.row(slot, 0)};
}

const double* SharedLegEvaluation::image_of(const SharedLegPlan& plan, uint32_t leg, size_t antenna) const {
  const AntennaImages& images = tables_.images[plan.legs[leg].of_receivers];
  return images.rows.row(images.entry(plan.legs[leg].image, antenna), 0);
}

// Cells on rigid meshes are those of the trace at all times.
void SharedLegEvaluation::find_cells(const SharedLegPlan& plan, const TraceCells& cells) {
  cells_.resize(plan.chains.size());
  for (size_t index = 0; index < plan.chains.size(); ++index) {
    const SharedLegPlan::ChainPath& chain = plan.chains[index];
    const bool is_rigid = !cells.may_stretch(plan.points[plan.legs[chain.end].point].mesh_id);
    if (chain.is_coherent && is_rigid) cells_[index] = cells.on_rigid(chain);
  }
}

void SharedLegEvaluation::place_cell(const SharedLegPlan& plan, size_t index, const TraceCells& cells,
                                     const PosedNodes& nodes, size_t slot) {
  const SharedLegPlan::ChainPath& chain = plan.chains[index];
  const uint32_t point = plan.legs[chain.end].point, mesh_id = plan.points[point].mesh_id;
  CoherentPath& path = coherent_[slot];
  path.point = tables_.points.rows.row(point, 0);
  stretching_[slot].clear();
  if (cells.may_stretch(mesh_id)) {
    path.mesh = world_.row(0, 0);
    stretching_[slot] = cells.on_stretching(chain, nodes);
  } else {
    path.mesh = nodes.meshes.row(mesh_id, 0);
    set_cell(cells_[index], path);
  }
}

void SharedLegEvaluation::evaluate_coherent(const SharedLegPlan& plan, const SharedLegPlan::ChainPath& chain,
                                            const Ends& ends, double scale, size_t slot, bool has_turn_apart) {
  CoherentPath& path = coherent_[slot];
  path.path = path_of(chain, ends, scale, slot);
  path.start_image = image_of(plan, chain.start, ends.start);
  path.end_image = image_of(plan, chain.end, ends.end);
  if (!stretching_[slot].empty()) return reflect_from_stretching(slot, has_turn_apart);
  const auto reflect = has_turn_apart ? kernels_->reflect_with_turn_apart : kernels_->reflect;
  reflect(path, 0, values_.stride(), values_.stride());
}

// Cells differ from node to node, and so does the area for which the ray stands.
void SharedLegEvaluation::reflect_from_stretching(size_t slot, bool has_turn_apart) {
  const SharedLegKernels& kernels = shared_leg_kernels_of_one();
  const auto reflect = has_turn_apart ? kernels.reflect_with_turn_apart : kernels.reflect;
  CoherentPath path = coherent_[slot];
  const ComplexOf<double> weight = path.path.weight;
  for (size_t node = 0; node < values_.num_nodes(); ++node) {
    set_cell(stretching_[slot][node], path);
    const double area_ratio = path.point[PointToPose::kAreaRatio * values_.stride() + node];
    path.path.weight = {area_ratio * weight.re, area_ratio * weight.im};
    reflect(path, node, node + 1, values_.stride());
  }
}

void SharedLegEvaluation::evaluate_diffuse(const SharedLegPlan::ChainPath& chain, const Ends& ends, double scale,
                                           size_t slot) {
  const bool has_inner = chain.inner != SharedLegPlan::kNone;
  const bool begins_specular = has_inner && tables_.inner.begins_specular[chain.inner];
  const bool is_single = !has_inner || tables_.inner.is_single[chain.inner];
  kernels_->combine({path_of(chain, ends, scale, slot), begins_specular, is_single}, values_.stride());
}

// Applies the polarisations and phases of the antennas at both ends, where its legs hold them, to a path.
void SharedLegEvaluation::turn(int64_t path, const MeasuredLeg& start, const MeasuredLeg& end, size_t slot) {
  if (start.table.has_components) polarize(path, start, end, slot);
  if (start.table.has_phases) turn_phase(start, end, slot);
}

void SharedLegEvaluation::polarize(int64_t path, const MeasuredLeg& start, const MeasuredLeg& end, size_t slot) {
  PathToPolarize work{
      start.table.components.row(start.leg, 0), end.table.components.row(end.leg, 0), {}, {}, values_.row(slot, 0)};
  const JonesMatrix& matrix = paths_->jones[path];
  for (size_t entry = 0; entry < matrix.size(); ++entry) {
    work.re[entry] = matrix[entry].real();
    work.im[entry] = matrix[entry].imag();
  }
  kernels_->polarize(work, values_.stride());
}

void SharedLegEvaluation::turn_phase(const MeasuredLeg& start, const MeasuredLeg& end, size_t slot) {
  const double *first = start.table.phases.row(start.leg, 0), *last = end.table.phases.row(end.leg, 0);
  double *re = values_.row(slot, PathToCombine::kRe), *im = values_.row(slot, PathToCombine::kIm);
  for (size_t node = 0; node < values_.num_nodes(); ++node) {
    const std::complex<double> turned = std::complex(re[node], im[node]) * std::polar(1.0, first[node] + last[node]);
    re[node] = turned.real();
    im[node] = turned.imag();
  }
}

// Returns the axes of the matrix of a path over flagged mirrors alone, at the transmitter and at the receiver.
std::array<AxesAcross<double>, 2> SharedLegEvaluation::axes_at_ends(const SharedLegPlan::MirrorPath& path) const {
  if (paths_->jones.empty()) return {};
  const Vec3 transmitter = mean_antenna_at_trace(*paths_, false), receiver = mean_antenna_at_trace(*paths_, true);
  const ImageAtTrace& image = tables_.traced_images[path.image];
  return {image.axes_toward(receiver, transmitter), ImageAtTrace().axes_toward(image.of(transmitter), receiver)};
}

// Each end sees the other over the mirrors: one leg leads from the transmitter's image to the receiver, and one back.
void SharedLegEvaluation::evaluate_mirrors(const SharedLegPlan::MirrorPath& path, const PosedNodes& nodes,
                                           const ChannelSpan& channels, double scale) {
  constexpr size_t kSlot = 0;
  // The components are needed between upright antennas too, because these send nothing straight up or down.
  mirror_legs_.resize(2, nodes.size(), tables_.has_phases, !paths_->jones.empty());
  const MeasuredLeg start{mirror_legs_, 0}, back{mirror_legs_, 1};
  const ComplexOf<double> weight{scale * path.weight.real(), scale * path.weight.imag()};
  const std::array<AxesAcross<double>, 2> recorded = axes_at_ends(path);
  for (size_t channel = 0; channel < channels.nodes.size(); ++channel) {
    const size_t of_all = channels.first + channel;
    const SharedLegTables::ImageOfAntenna ends[] = {{false, path.image, of_all / num_receivers_, &recorded[0]},
                                                    {true, 0, of_all % num_receivers_, &recorded[1]}};
    for (const size_t end : {0, 1}) {
      const SharedLegTables::ImageOfAntenna& other = ends[1 - end];
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

bool SharedLegEvaluation::turns(uint32_t leg) const {
  const double* factor = tables_.legs.rows.row(leg * tables_.stride, LegToMeasure::kFactor);
  return std::signbit(factor[0]) != std::signbit(factor[values_.num_nodes() - 1]);
}

void SharedLegEvaluation::mark_turned(const SharedLegPlan& plan, uint8_t* turned) const {
  for (const SharedLegPlan::ChainPath& chain : plan.chains) turned[chain.place] = turns(chain.start) || turns(chain.end);
}

double SharedLegEvaluation::size_of_weight(const SharedLegPlan::ChainPath& chain) const {
  const ComplexOf<double> weight = scaled_weight(chain, 1.0);
  const double size = std::hypot(weight.re, weight.im);
  if (!tables_.has_polarizations) return size;
  double largest = 0.0;
  for (const auto& entry : paths_->jones[chain.path]) {
    largest = std::max(largest, static_cast<double>(std::abs(entry)));
  }
  return size * largest;
}

// Takes the cosine of the departure for that of the arrival, and no curvature of the surfaces before.
double SharedLegEvaluation::unfiltered(const SharedLegPlan::ChainPath& chain, const RadioConstants& radio) const {
  const size_t stride = values_.stride();
  const double *const start = start_of(chain, 0).rows(), *const end = end_of(chain, 0).rows();
  const double* const inner = inner_of(chain, 0);
  const auto value = [&](const double* rows, int row) { return rows[static_cast<size_t>(row) * stride]; };
  const double out = value(end, LegToMeasure::kLength), in = value(start, LegToMeasure::kLength) + (inner ? *inner : 0.0);
  const double gain = value(end, LegToMeasure::kGain), factor = value(end, LegToMeasure::kFactor);
  if (!(gain > 0.0)) return 0.0;
  const double gains = value(start, LegToMeasure::kGain) * gain, cosine = cosine_of_leg(factor, gain, out);
  const double of_cell = radio.coherent_scale() * size_of_weight(chain) * coherent_size(gains, cosine, 1.0 / in, 1.0 / out);
  return std::min(of_cell, radio.mirror_scale() * mirror_size(gains, in + out));
}

void SharedLegEvaluation::mark_unfiltered(const SharedLegPlan& plan, const RadioConstants& radio, double* unfiltered) const {
  for (const SharedLegPlan::ChainPath& chain : plan.chains) {
    if (chain.is_coherent) unfiltered[chain.place] = this->unfiltered(chain, radio);
  }
}

// Writes the values of some paths to their places, node by node, because neighbours share the lines of the cache.
template <class Path>
void SharedLegEvaluation::put(std::span<const Path> paths, const ChannelNodes& to) const {
  const double* const values = values_.row(0, 0);
  const size_t stride = values_.stride(), of_slot = PathToCombine::kNumRows * stride;
  for (size_t node = 0; node < values_.num_nodes(); ++node) {
    const double* value = values + node;
    for (const Path& path : paths) {
      to.set(node, path.place, value[PathToCombine::kLength * stride],
             {value[PathToCombine::kRe * stride], value[PathToCombine::kIm * stride]});
      if (to.turn) to.turn[node * to.stride + to.echo(path.place)] = value[PathToCombine::kTurn * stride];
      value += of_slot;
    }
  }
}

}  // namespace echopath
