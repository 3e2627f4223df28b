#include "echopath/spectrum/angle/beamform.h"

#include <algorithm>
#include <stdexcept>

#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/spectrum/angle/beam_source.h"

namespace echopath {
namespace {

constexpr int kMaxNeighbours = 64;
constexpr double kMinLoading = 1e-9, kMaxLoading = 1e3;

// Describes neighbouring ranges of one velocity, and where their powers are written.
struct Strip {
  int64_t velocity, first, count, out;
};

std::vector<Strip> strips_of(const RangeDoppler& map) {
  std::vector<Strip> strips;
  const int64_t num_ranges = std::ssize(map.range);
  for (int64_t v = 0; v < std::ssize(map.velocity); ++v) {
    for (int64_t first = 0; first < num_ranges; first += BeamKernel::kColumns) {
      strips.push_back({v, first, std::min(BeamKernel::kColumns, num_ranges - first), v * num_ranges + first});
    }
  }
  return strips;
}

std::vector<Strip> strips_of(const std::vector<Cell>& cells) {
  std::vector<Strip> strips;
  for (const Cell& cell : cells) strips.push_back({cell[0], cell[1], 1, std::ssize(strips)});
  return strips;
}

BeamKernel::Powers bartlett_strip(const BeamSource& source, const BeamKernel& beams, const Strip& strip) {
  BeamKernel::Powers power(beams.num_directions() * BeamKernel::kColumns);
  beams.add_squares(source.weighted(strip.velocity, strip.first, strip.count), Combine::kSum, power);
  return power;
}

BeamKernel::Powers capon_strip(const BeamSource& source, const BeamKernel& beams, const Strip& strip, const Job* job) {
  BeamKernel::Powers power(beams.num_directions() * BeamKernel::kColumns);
  for (int64_t i = 0; i < strip.count; ++i) {
    const Eigen::VectorXd values = source.cell(strip.velocity, strip.first + i).power(beams, Combine::kSum, job);
    for (int64_t d = 0; d < values.size(); ++d) power[d * BeamKernel::kColumns + i] = values[d];
  }
  return power;
}

// Returns the powers [directions, num_cells].
std::vector<double> powers(const BeamSource& source, const AngleGrid& angles, BeamMethod method,
                           const std::vector<Strip>& strips, int64_t num_cells, Job* job) {
  const BeamKernel beams(source.array(), beam_directions(source.array(), angles));
  std::vector<double> power(beams.num_directions() * num_cells);
  if (job) job->start(std::ssize(strips));
  parallel_for(std::ssize(strips), [&](int64_t task) {
    const Strip& strip = strips[task];
    const bool is_bartlett = method == BeamMethod::kBartlett;
    const BeamKernel::Powers values =
        is_bartlett ? bartlett_strip(source, beams, strip) : capon_strip(source, beams, strip, job);
    for (int64_t d = 0; d < beams.num_directions(); ++d) {
      std::copy_n(values.data() + d * BeamKernel::kColumns, strip.count, power.data() + d * num_cells + strip.out);
    }
  }, job);
  return power;
}

}  // namespace

void BeamformOptions::validate() const {
  require(diagonal_loading >= kMinLoading && diagonal_loading <= kMaxLoading, "diagonal_loading", "must be in [1e-9, 1e3]",
          diagonal_loading);
  for (const int reach : {velocity_neighbours, range_neighbours}) {
    require(reach >= 0 && reach <= kMaxNeighbours, "neighbours", "must be in [0, 64]", reach);
  }
  const bool is_plain = window.kind == WindowKind::kRect;
  require(method == BeamMethod::kBartlett || is_plain, "window", "must be rect for capon, which finds its own weights",
          window.name());
}

void require_cells_of(const RangeDoppler& map, const std::vector<Cell>& cells) {
  const int64_t limits[] = {std::ssize(map.velocity), std::ssize(map.range)};
  for (const Cell& cell : cells) {
    for (int k = 0; k < 2; ++k) {
      if (cell[k] >= 0 && cell[k] < limits[k]) continue;
      throw std::out_of_range("cells: must be (velocity, range) indices below (" + std::to_string(limits[0]) + ", " +
                              std::to_string(limits[1]) + "), got (" + std::to_string(cell[0]) + ", " +
                              std::to_string(cell[1]) + ")");
    }
  }
}

BeamPower beamform(const RangeDoppler& map, const Radar& radar, const AngleGrid& angles, const BeamformOptions& options,
                   Job* job) {
  angles.validate();
  const BeamSource source(map, radar, options);
  const int64_t num_cells = static_cast<int64_t>(map.velocity.size() * map.range.size());
  return {angles.azimuth, angles.elevation,
          map.velocity,   map.range,
          false,          powers(source, angles, options.method, strips_of(map), num_cells, job)};
}

BeamPower beamform(const RangeDoppler& map, const Radar& radar, const std::vector<Cell>& cells, const AngleGrid& angles,
                   const BeamformOptions& options, Job* job) {
  angles.validate();
  const BeamSource source(map, radar, options);
  require_cells_of(map, cells);
  BeamPower result{angles.azimuth, angles.elevation, {}, {}, true, {}};
  for (const Cell& cell : cells) {
    result.velocity.push_back(map.velocity[cell[0]]);
    result.range.push_back(map.range[cell[1]]);
  }
  result.power = powers(source, angles, options.method, strips_of(cells), std::ssize(cells), job);
  return result;
}

}  // namespace echopath
