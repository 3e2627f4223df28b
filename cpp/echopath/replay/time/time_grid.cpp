#include "echopath/replay/time/time_grid.h"

namespace echopath {
namespace {

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};

}  // namespace

FrameNodes nodes_of(const TimeGrid& grid, const Radar& radar, double start_time, ChirpDerivatives derivatives) {
  return std::visit(Overloaded{
                        [&](const StillGrid& still) { return static_nodes(radar, still.time); },
                        [&](const PolynomialGrid& polynomial) {
    return chebyshev_nodes(radar, start_time, polynomial.cuts, polynomial.order, derivatives);
  },
                        [&](const ChirpGrid& chirps) { return centre_nodes(radar, start_time, chirps.transmitter); },
                        [&](const SampleGrid& samples) {
    return exact_nodes(radar, start_time, samples.order, samples.transmitter, derivatives);
  },
                    },
                    grid);
}

int transmitter_of(const TimeGrid& grid) {
  if (const auto* chirps = std::get_if<ChirpGrid>(&grid)) return chirps->transmitter;
  if (const auto* samples = std::get_if<SampleGrid>(&grid)) return samples->transmitter;
  return -1;
}

}  // namespace echopath
