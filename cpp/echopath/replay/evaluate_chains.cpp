#include "echopath/replay/evaluate_chains.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/replay/diffuse_chain.h"

namespace echopath {
namespace {

bool has_phase(const Antenna& antenna) { return antenna.pattern.table && !antenna.pattern.table->phase().empty(); }

}  // namespace

void ChainEvaluation::operator()(const ChainPlan& plan, const Localiser& localise, const LevelView& level, const RadioConstants& radio,
                                 const ChannelSpan& channels) {
  if (plan.chains.empty()) return;
  num_receivers_ = level.instants.front().receivers.size();
  paths_ = &localise.paths();
  polarizes_ = ChainTables::needs_polarizations(*paths_, level);
  tables_.find(plan, localise, level);
  values_.resize(kTogether, PathToCombine::kNumRows, level.instants.size());
  kernels_ = &chain_kernels(values_.stride());
  const TraceCells cell_of(plan, localise, tables_.points);
  const double of_coherent = std::sqrt(radio.transmit_power) / (4.0 * kPi), of_diffuse = diffuse_scale(radio);
  for (CoherentPath& path : coherent_) path.filter = radio.filter();
  for (size_t first = 0; first < plan.chains.size(); first += kTogether) {
    const Chains chains(plan.chains.data() + first, std::min(kTogether, plan.chains.size() - first));
    for (size_t slot = 0; slot < chains.size(); ++slot) {
      if (chains[slot].is_coherent) add_cell(plan, chains[slot], cell_of(chains[slot]), level, coherent_[slot]);
    }
    for (size_t channel = 0; channel < channels.nodes.size(); ++channel) {
      for (size_t slot = 0; slot < chains.size(); ++slot) {
        const Ends ends = ends_of(chains[slot], channels.first + channel);
        if (chains[slot].is_coherent) evaluate_coherent(plan, chains[slot], ends, of_coherent, slot);
        else evaluate_diffuse(chains[slot], ends, of_diffuse, slot);
        if (polarizes_) polarize(chains[slot], ends, slot);
      }
      put(chains, channels.nodes[channel]);
    }
  }
}

ChainEvaluation::Ends ChainEvaluation::ends_of(const ChainPlan::Chain& chain, size_t channel) const {
  const size_t transmitter = channel / num_receivers_, receiver = channel % num_receivers_;
  return chain.is_reversed ? Ends{receiver, transmitter} : Ends{transmitter, receiver};
}

// Between upright antennas one entry of a matrix is all that counts.
std::complex<double> ChainEvaluation::weight_of(const ChainPlan::Chain& chain) const {
  if (paths_->jones.empty() || polarizes_) return chain.weight;
  return chain.weight * std::complex<double>(paths_->jones[static_cast<size_t>(chain.path)][3]);
}

PathToCombine ChainEvaluation::path_of(const ChainPlan::Chain& chain, const Ends& ends, double scale, size_t slot) {
  const ChainLegs& legs = tables_.legs;
  const double* inner = chain.inner == ChainPlan::kNone ? nullptr : tables_.inner.rows.row(chain.inner, 0);
  const std::complex<double> weight = weight_of(chain);
  return {legs.rows.row(chain.start * legs.stride + ends.start, 0), legs.rows.row(chain.end * legs.stride + ends.end, 0), inner,
          scale * weight.real(), scale * weight.imag(), values_.row(slot, 0)};
}

const double* ChainEvaluation::image_of(const ChainPlan& plan, uint32_t leg, size_t antenna) const {
  const AntennaImages& images = tables_.images[plan.legs[leg].of_receivers];
  return images.rows.row(plan.legs[leg].image * images.num_antennas + antenna, 0);
}

void ChainEvaluation::add_cell(const ChainPlan& plan, const ChainPlan::Chain& chain, const RigidCell& cell, const LevelView& level,
                               CoherentPath& path) const {
  const uint32_t point = plan.legs[chain.end].point;
  path.cell = cell.shape;
  path.root_area = cell.root_area;
  for (int a = 0; a < 2; ++a) std::copy_n(cell.tangent[a].data(), 3, path.tangent[a]);
  path.point = tables_.points.rows.row(point, 0);
  path.mesh = level.poses.meshes.row(plan.points[point].mesh_id, 0);
}

void ChainEvaluation::evaluate_coherent(const ChainPlan& plan, const ChainPlan::Chain& chain, const Ends& ends, double scale,
                                        size_t slot) {
  CoherentPath& path = coherent_[slot];
  path.path = path_of(chain, ends, scale, slot);
  path.start_image = image_of(plan, chain.start, ends.start);
  path.end_image = image_of(plan, chain.end, ends.end);
  kernels_->reflect(path, values_.stride());
}

void ChainEvaluation::evaluate_diffuse(const ChainPlan::Chain& chain, const Ends& ends, double scale, size_t slot) {
  const bool has_inner = chain.inner != ChainPlan::kNone;
  const bool begins_specular = has_inner && tables_.inner.begins_specular[chain.inner];
  const bool is_single = !has_inner || tables_.inner.is_single[chain.inner];
  kernels_->combine({path_of(chain, ends, scale, slot), begins_specular, is_single}, values_.stride());
}

void ChainEvaluation::polarize(const ChainPlan::Chain& chain, const Ends& ends, size_t slot) {
  const size_t stride = tables_.legs.stride;
  const NodeRows& rows = tables_.polarizations.rows;
  PathToPolarize path{rows.row(chain.start * stride + ends.start, 0), rows.row(chain.end * stride + ends.end, 0), {}, {},
                      values_.row(slot, 0)};
  const JonesMatrix& matrix = paths_->jones[static_cast<size_t>(chain.path)];
  for (size_t entry = 0; entry < matrix.size(); ++entry) {
    path.re[entry] = matrix[entry].real();
    path.im[entry] = matrix[entry].imag();
  }
  kernels_->polarize(path, values_.stride());
}

bool ChainEvaluation::turns(uint32_t leg) const {
  const double* factor = tables_.legs.rows.row(leg * tables_.legs.stride, LegToMeasure::kFactor);
  return std::signbit(factor[0]) != std::signbit(factor[values_.num_nodes() - 1]);
}

void ChainEvaluation::mark_turned(const ChainPlan& plan, uint8_t* turned) const {
  for (const ChainPlan::Chain& chain : plan.chains) turned[chain.place] = turns(chain.start) || turns(chain.end);
}

// The values of some paths to their places, node by node: neighbours share the lines of the cache.
void ChainEvaluation::put(Chains chains, const ChannelNodes& to) const {
  const double* const values = values_.row(0, 0);
  const size_t stride = values_.stride(), of_slot = PathToCombine::kNumRows * stride;
  for (size_t node = 0; node < values_.num_nodes(); ++node) {
    const double* value = values + node;
    for (const ChainPlan::Chain& chain : chains) {
      to.set(node, chain.place, value[PathToCombine::kLength * stride],
             {value[PathToCombine::kRe * stride], value[PathToCombine::kIm * stride]});
      value += of_slot;
    }
  }
}

bool has_phase(const Radar& radar) {
  const auto of_one = [](const Antenna& antenna) { return has_phase(antenna); };
  return std::any_of(radar.transmitters.begin(), radar.transmitters.end(), of_one) ||
         std::any_of(radar.receivers.begin(), radar.receivers.end(), of_one);
}

}  // namespace echopath
