// The part of the replayer that interpolates logarithms of amplitudes.
#include <cmath>
#include <vector>

#include "echopath/base/constants.h"
#include "echopath/replay/echo_memory.h"
#include "echopath/replay/replay.h"
#include "echopath/replay/time/chebyshev_tails.h"

namespace echopath {
namespace {

// Of the tolerance of amplitudes, so that what is left out of logarithms adds nothing to what is left out of amplitudes.
constexpr double kShareOfTolerance = 0.1;

// What is left of the phase without its turn changes by less from node to node, or its turn is not all that turns.
constexpr double kLargestStep = 1.0;  // rad

// Turns the amplitudes of one echo into logarithms, (size, phase) at each node. Returns whether they have any.
bool take_logarithms(size_t num_nodes, size_t stride, const double* turn, std::complex<double>* amplitude) {
  double before = 0.0;
  for (size_t node = 0; node < num_nodes; ++node, turn += stride, amplitude += stride) {
    const double size = std::abs(*amplitude), own = std::arg(*amplitude);
    if (!(size > 0.0) || !std::isfinite(*turn)) return false;
    const double phase = node == 0 ? own : before + std::remainder(own - before, 2.0 * kPi);
    if (node > 0 && std::abs(phase - before) > kLargestStep) return false;
    before = phase;
    *amplitude = {std::log(size), phase + *turn};
  }
  return true;
}

}  // namespace

// Images have no launch cell, and edges have a filter of their own.
bool Replayer::can_turn(int64_t path) const {
  return radio_.footprint != Footprint::kEdges && paths_.is_coherent_with_cell(path);
}

std::vector<Echoes> Replayer::turning(std::span<const int64_t> indices, GridIndex polynomial,
                                      std::vector<UnfollowedPath>& unfollowed, const SomeTransmitters& transmitters) const {
  const PosedGrid& grid = posed_.polynomial(polynomial);
  const size_t num_nodes = grid.posed.size();
  std::vector<Echoes> echoes = take_echoes_of(grid, transmitters, indices.size());
  std::vector<std::vector<double>> turns(echoes.size(), std::vector<double>(indices.size() * num_nodes));
  evaluate_turning(indices, grid, transmitters.first * num_receivers(), echoes, turns);
  std::vector<uint8_t> is_followed(indices.size(), 1);
  for (size_t channel = 0; channel < echoes.size(); ++channel) {
    Echoes& here = echoes[channel];
    here.sampling.rows = TimeSampling::Rows::kLogarithms;
    for (size_t p = 0; p < indices.size(); ++p) {
      is_followed[p] &= take_logarithms(num_nodes, indices.size(), &turns[channel][p], &here.amplitude[p]);
    }
    const std::vector<double> tails = tails_of_logarithms(grid.nodes, here);
    const double tolerance = kShareOfTolerance * settings_.amplitude_tolerance();
    for (size_t p = 0; p < indices.size(); ++p) is_followed[p] &= tails[p] <= tolerance;
  }
  std::vector<size_t> followed;
  for (size_t p = 0; p < indices.size(); ++p) {
    if (is_followed[p]) followed.push_back(p);
    else unfollowed.push_back({.path = indices[p]});
  }
  if (followed.size() == indices.size()) return echoes;
  for (Echoes& channel : echoes) keep_echoes(followed, channel);
  return echoes;
}

}  // namespace echopath
