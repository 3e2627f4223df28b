#include "echopath/spectrum/angle/range_azimuth.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/spectrum/angle/beam_source.h"

namespace echopath {
namespace {

// Returns the ratio of a point's power to its sum over the velocities.
double share_of_sum(const RangeDoppler& map, int num_chirps) {
  const double bandwidth = equivalent_noise_bandwidth(window_samples(map.window.velocity, num_chirps));
  return num_chirps / (bandwidth * static_cast<double>(map.velocity.size()));
}

int64_t nearest_velocity(const RangeDoppler& map, double velocity) {
  const auto is_nearer = [velocity](double a, double b) { return std::abs(a - velocity) < std::abs(b - velocity); };
  const auto nearest = std::ranges::min_element(map.velocity, is_nearer);
  const size_t count = map.velocity.size();
  const double step = count > 1 ? (map.velocity.back() - map.velocity.front()) / static_cast<double>(count - 1) : 0.0;
  require(count == 1 || std::abs(*nearest - velocity) <= 0.5 * step * (1.0 + 1e-9), "velocity",
          "must be on the map's axis (" + std::to_string(map.velocity.front()) + " to " +
              std::to_string(map.velocity.back()) + " m/s)",
          velocity);
  return nearest - map.velocity.begin();
}

// Names the velocities [begin, end) of a map.
struct VelocityRows {
  int64_t begin, end;
};

VelocityRows rows_in(const RangeDoppler& map, const std::array<double, 2>& gate) {
  const auto& axis = map.velocity;
  const VelocityRows rows{std::ranges::lower_bound(axis, gate[0]) - axis.begin(),
                          std::ranges::upper_bound(axis, gate[1]) - axis.begin()};
  require(rows.begin < rows.end, "velocity_gate",
          "must hold a cell of the axis (" + std::to_string(axis.front()) + " to " + std::to_string(axis.back()) + " m/s)",
          std::to_string(gate[0]) + " to " + std::to_string(gate[1]));
  return rows;
}

VelocityRows chosen_rows(const RangeDoppler& map, const VelocityChoice& choice) {
  if (choice.velocity) {
    require(!choice.gate, "velocity_gate", "must not stand beside velocity", *choice.velocity);
    const int64_t row = nearest_velocity(map, *choice.velocity);
    return {row, row + 1};
  }
  return choice.gate ? rows_in(map, *choice.gate) : VelocityRows{0, std::ssize(map.velocity)};
}

// Computes the map of one choice of velocities, by strips of ranges.
struct Picture {
  const BeamSource& source;
  const BeamKernel& beams;
  VelocityRows rows;
  bool is_one_cell;  // not all velocities, but those of a cell
  Combine combine;
  const Job* job;

  BeamKernel::Powers bartlett(int64_t first, int64_t count) const {
    BeamKernel::Powers power(beams.num_directions() * BeamKernel::kColumns);
    for (int64_t v = rows.begin; v < rows.end; ++v) {
      if (job) job->throw_if_cancelled();
      beams.add_squares(source.weighted(v, first, count), combine, power);
    }
    return power;
  }

  BeamKernel::Powers capon(int64_t first, int64_t count) const {
    BeamKernel::Powers power(beams.num_directions() * BeamKernel::kColumns);
    for (int64_t i = 0; i < count; ++i) {
      const CellBeam beam =
          is_one_cell ? source.cell(rows.begin, first + i) : source.velocities(rows.begin, rows.end, first + i);
      const Eigen::VectorXd values = beam.power(beams, combine, job);
      for (int64_t d = 0; d < values.size(); ++d) power[d * BeamKernel::kColumns + i] = values[d];
    }
    return power;
  }
};

}  // namespace

RangeAzimuth range_azimuth(const RangeDoppler& map, const Radar& radar, const AngleGrid& angles,
                           const VelocityChoice& choice, const BeamformOptions& options, Job* job) {
  angles.validate();
  const BeamSource source(map, radar, options);
  RangeAzimuth result{angles.azimuth, map.range, angles.elevation, {}, {}};
  const VelocityRows rows = chosen_rows(map, choice);
  if (choice.velocity) result.velocity = map.velocity[rows.begin];
  const bool is_sum = !choice.velocity && choice.combine == Combine::kSum;
  const double scale = is_sum ? share_of_sum(map, radar.waveform.num_chirps) : 1.0;
  const BeamKernel beams(source.array(), beam_directions(source.array(), angles));
  const Picture picture{source, beams, rows, choice.velocity.has_value(), choice.combine, job};
  const int64_t num_ranges = std::ssize(map.range);
  const int64_t num_azimuths = std::ssize(angles.azimuth);
  result.power.assign(num_azimuths * num_ranges, 0.0);

  if (job) job->start(num_chunks(num_ranges, BeamKernel::kColumns));
  parallel_for_chunks(num_ranges, BeamKernel::kColumns, [&](int64_t first, int64_t end) {
    const int64_t count = end - first;
    const bool is_bartlett = options.method == BeamMethod::kBartlett;
    const BeamKernel::Powers power = is_bartlett ? picture.bartlett(first, count) : picture.capon(first, count);
    for (int64_t d = 0; d < beams.num_directions(); ++d) {
      double* out = result.power.data() + d % num_azimuths * num_ranges + first;
      for (int64_t i = 0; i < count; ++i) out[i] = std::max(out[i], scale * power[d * BeamKernel::kColumns + i]);
    }
  }, job);
  return result;
}

}  // namespace echopath
