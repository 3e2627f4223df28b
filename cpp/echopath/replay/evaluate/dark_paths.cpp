// The part of the evaluation that finds coherent paths whose launch cells are dark to all antennas.
#include <algorithm>
#include <cmath>

#include "echopath/replay/evaluate/shared_legs.h"
#include "echopath/replay/time/chebyshev_tails.h"

namespace echopath {
namespace {

// Returns the largest distance (m) of any antenna from the first, at any node.
double distance_from_first(const NodeRows& antennas, size_t count) {
  double square = 0.0;
  for (size_t antenna = 1; antenna < count; ++antenna) {
    for (size_t node = 0; node < antennas.num_nodes(); ++node) {
      const Vec3 apart = load(antennas, antenna, LegToMeasure::kImagePosition, node) -
                         load(antennas, 0, LegToMeasure::kImagePosition, node);
      square = std::max(square, apart.squaredNorm());
    }
  }
  return std::sqrt(square);
}

}  // namespace

// Describes the antennas of one end.
struct SharedLegEvaluation::Around {
  double distance;   // m, of any of them from the first
  double root_gain;  // at most

  Around(const AntennaImages& images, const NodeRows& antennas)
      : distance(distance_from_first(antennas, images.num_antennas)), root_gain(0.0) {
    for (const AntennaPattern* pattern : images.pattern) root_gain = std::max(root_gain, pattern->largest_field());
  }
};

// A filter of kEdges is a sum of several. Paths with points of reflection that move, on meshes that stretch or through
// sheets are evaluated to tell.
void SharedLegEvaluation::find_dark(const SharedLegPlan& plan, const PathPreparer& preparer, const PosedNodes& nodes,
                                    const FrameNodes& times, const RadioConstants& radio, double limit,
                                    std::vector<uint8_t>& dark) {
  if (plan.chains.empty() || times.num_pieces() == 0 || radio.footprint == Footprint::kEdges ||
      !preparer.paths().passes.empty())
    return;
  prepare(plan, preparer, nodes, radio);
  bounds_.resize(1, AmplitudeToBound::kNumRows, nodes.size());
  const TraceCells cells(plan, preparer, tables_.points);
  const Around around[] = {{tables_.images[0], nodes.antennas[0]}, {tables_.images[1], nodes.antennas[1]}};
  for (size_t index = 0; index < plan.chains.size(); ++index) {
    const SharedLegPlan::ChainPath& chain = plan.chains[index];
    if (!chain.is_coherent || chain.slide != SharedLegPlan::kNone || !cells_[index].shape.is_known) continue;
    place_cell(plan, index, cells, nodes, 0);
    dark[chain.place] = is_dark(plan, chain, times, radio.coherent_scale(), limit, around);
  }
}

bool SharedLegEvaluation::is_dark(const SharedLegPlan& plan, const SharedLegPlan::ChainPath& chain, const FrameNodes& times,
                                  double scale, double limit, const Around (&around)[2]) {
  constexpr double kPolarized = 2.0;  // times the largest entry of a matrix between two polarisations
  CoherentPath& path = coherent_[0];
  path.path = path_of(chain, {0, 0}, scale, 0);
  path.start_image = image_of(plan, chain.start, 0);
  path.end_image = image_of(plan, chain.end, 0);
  const Around &start = around[chain.is_reversed], &end = around[!chain.is_reversed];
  kernels_->bound({path, start.distance, end.distance, bounds_.row(0, 0)}, bounds_.stride());
  const double size = kPolarized * scale * size_of_weight(chain) * start.root_gain * end.root_gain;
  const double most = std::log(limit / size);
  double* logarithm = bounds_.row(0, AmplitudeToBound::kFilter);
  const double* spreading = bounds_.row(0, AmplitudeToBound::kSpreading);
  for (size_t node = 0; node < bounds_.num_nodes(); ++node) {
    if (!(spreading[node] > 0.0)) return false;
    logarithm[node] -= std::log(spreading[node]);
    if (!(logarithm[node] < most)) return false;
  }
  return stays_below(times, logarithm, most);
}

// The cells that were found are by chain.
void SharedLegEvaluation::leave_out(const SharedLegPlan& plan, const std::vector<uint8_t>& places) {
  size_t to = 0;
  for (size_t index = 0; index < cells_.size(); ++index) {
    if (places[plan.chains[index].place]) continue;
    if (to != index) cells_[to] = cells_[index];
    ++to;
  }
  cells_.resize(to);
}

}  // namespace echopath
