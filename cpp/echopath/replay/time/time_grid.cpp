#include "echopath/replay/time/time_grid.h"

namespace echopath {

FrameNodes nodes_of(const TimeGrid& grid, const Radar& radar, double start_time, ChirpDerivatives derivatives) {
  if (const auto* still = std::get_if<StillGrid>(&grid)) return static_nodes(radar, still->time);
  if (const auto* chirps = std::get_if<ChirpGrid>(&grid)) return centre_nodes(radar, start_time, chirps->transmitter);
  if (const auto* samples = std::get_if<SampleGrid>(&grid)) {
    return exact_nodes(radar, start_time, samples->order, samples->transmitter, derivatives);
  }
  const auto& polynomial = std::get<PolynomialGrid>(grid);
  return chebyshev_nodes(radar, start_time, polynomial.cuts, polynomial.order, derivatives);
}

int transmitter_of(const TimeGrid& grid) {
  if (const auto* chirps = std::get_if<ChirpGrid>(&grid)) return chirps->transmitter;
  if (const auto* samples = std::get_if<SampleGrid>(&grid)) return samples->transmitter;
  return -1;
}

}  // namespace echopath
