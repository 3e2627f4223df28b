#include "echopath/replay/evaluate_chains.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/replay/diffuse_chain.h"
#include "echopath/replay/trace_cells.h"

namespace echopath {
namespace {

bool has_phase(const Antenna& antenna) { return antenna.pattern.table && !antenna.pattern.table->phase().empty(); }

}  // namespace

void ChainEvaluation::operator()(const ChainPlan& plan, const Localiser& localise, const LevelView& level, const RadioConstants& radio,
                                 const ChannelSpan& channels) {
  if (plan.chains.empty() && plan.coherent.empty()) return;
  num_receivers_ = level.instants.front().receivers.size();
  tables_.find(plan, localise, level);
  values_.resize(1, PathToCombine::kNumRows, level.instants.size());
  write_diffuse(plan, diffuse_scale(radio), channels);
  write_coherent(plan, localise, level, radio, channels);
}

ChainEvaluation::Ends ChainEvaluation::ends_of(const ChainPlan::Chain& chain, size_t channel) const {
  const size_t transmitter = channel / num_receivers_, receiver = channel % num_receivers_;
  return chain.is_reversed ? Ends{receiver, transmitter} : Ends{transmitter, receiver};
}

PathToCombine ChainEvaluation::path_of(const ChainPlan::Chain& chain, const Ends& ends, double scale) {
  const ChainLegs& legs = tables_.legs;
  const double* inner = chain.inner == ChainPlan::kNone ? nullptr : tables_.inner.rows.row(chain.inner, 0);
  return {legs.rows.row(chain.start * legs.stride + ends.start, 0), legs.rows.row(chain.end * legs.stride + ends.end, 0), inner,
          scale * chain.weight.real(), scale * chain.weight.imag(), values_.row(0, 0)};
}

void ChainEvaluation::write_diffuse(const ChainPlan& plan, double scale, const ChannelSpan& channels) {
  const ChainKernels& kernels = chain_kernels(values_.stride());
  for (const ChainPlan::Chain& chain : plan.chains) {
    const bool has_inner = chain.inner != ChainPlan::kNone;
    const bool begins_specular = has_inner && tables_.inner.begins_specular[chain.inner];
    const bool is_single = !has_inner || tables_.inner.is_single[chain.inner];
    for (size_t channel = 0; channel < channels.nodes.size(); ++channel) {
      kernels.combine({path_of(chain, ends_of(chain, channels.first + channel), scale), begins_specular, is_single}, values_.stride());
      put(chain.place, channels.nodes[channel]);
    }
  }
}

const double* ChainEvaluation::image_of(const ChainPlan& plan, uint32_t leg, size_t antenna) const {
  const AntennaImages& images = tables_.images[plan.legs[leg].of_receivers];
  return images.rows.row(plan.legs[leg].image * images.num_antennas + antenna, 0);
}

void ChainEvaluation::write_coherent(const ChainPlan& plan, const Localiser& localise, const LevelView& level,
                                     const RadioConstants& radio, const ChannelSpan& channels) {
  if (plan.coherent.empty()) return;
  const ChainKernels& kernels = chain_kernels(values_.stride());
  const TraceCells cell_of(plan, localise, tables_.points);
  const double scale = std::sqrt(radio.transmit_power) / (4.0 * kPi);
  CoherentPath path;
  path.filter = {radio.wavenumber, radio.spread, radio.footprint};
  for (const ChainPlan::Chain& chain : plan.coherent) {
    const RigidCell cell = cell_of(chain);
    const uint32_t point = plan.legs[chain.end].point;
    path.cell = cell.shape;
    path.root_area = cell.root_area;
    for (int a = 0; a < 2; ++a) std::copy_n(cell.tangent[a].data(), 3, path.tangent[a]);
    path.point = tables_.points.rows.row(point, 0);
    path.mesh = level.poses.meshes.row(plan.points[point].mesh_id, 0);
    for (size_t channel = 0; channel < channels.nodes.size(); ++channel) {
      const Ends ends = ends_of(chain, channels.first + channel);
      path.path = path_of(chain, ends, scale);
      path.start_image = image_of(plan, chain.start, ends.start);
      path.end_image = image_of(plan, chain.end, ends.end);
      kernels.reflect(path, values_.stride());
      put(chain.place, channels.nodes[channel]);
    }
  }
}

// The values of one path to their places.
void ChainEvaluation::put(size_t place, const ChannelNodes& to) const {
  const double *length = values_.row(0, PathToCombine::kLength), *re = values_.row(0, PathToCombine::kRe);
  const double* im = values_.row(0, PathToCombine::kIm);
  for (size_t node = 0; node < values_.num_nodes(); ++node) to.set(node, place, length[node], {re[node], im[node]});
}

bool has_phase(const Radar& radar) {
  const auto of_one = [](const Antenna& antenna) { return has_phase(antenna); };
  return std::any_of(radar.transmitters.begin(), radar.transmitters.end(), of_one) ||
         std::any_of(radar.receivers.begin(), radar.receivers.end(), of_one);
}

}  // namespace echopath
