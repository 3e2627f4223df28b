#include "echopath/signal/echoes/echoes.h"

#include <algorithm>
#include <cmath>

#include "echopath/base/errors.h"

namespace echopath {
namespace {

void require_ascending(const std::vector<double>& times) {
  require(!times.empty(), "times", "must hold at least one time", times.size());
  for (size_t i = 0; i < times.size(); ++i) {
    require(std::isfinite(times[i]), "times", "must be finite", times[i]);
    require(i == 0 || times[i] > times[i - 1], "times", "must be strictly ascending", times[i]);
  }
}

// Returns the derivative at t of the parabola through three points as weights of the three values.
void three_point_slope(const double* node, double t, double* weight) {
  for (int k = 0; k < 3; ++k) {
    const double a = node[(k + 1) % 3], b = node[(k + 2) % 3];
    weight[k] = ((t - a) + (t - b)) / ((node[k] - a) * (node[k] - b));
  }
}

}  // namespace

TimeSampling static_sampling(int num_chirps) {
  require(num_chirps >= 1, "num_chirps", "must be at least 1", num_chirps);
  const size_t count = static_cast<size_t>(num_chirps);
  TimeSampling sampling;
  sampling.first_row.assign(count, 0);
  sampling.value.assign(count, 1.0);
  sampling.slope.assign(count, 0.0);
  return sampling;
}

TimeSampling exact_sampling(const std::vector<double>& times) {
  require_ascending(times);
  const int count = static_cast<int>(times.size());
  if (count == 1) return static_sampling(1);
  TimeSampling sampling;
  sampling.num_rows = count;
  sampling.order = std::min(count, 3);
  sampling.first_row.resize(times.size());
  sampling.value.assign(times.size() * sampling.order, 0.0);
  sampling.slope.resize(times.size() * sampling.order);
  for (int j = 0; j < count; ++j) {
    const int first = std::clamp(j - 1, 0, count - sampling.order);
    double* slope = &sampling.slope[static_cast<size_t>(j) * sampling.order];
    sampling.first_row[j] = first;
    sampling.value[static_cast<size_t>(j) * sampling.order + (j - first)] = 1.0;
    if (count == 2) {
      slope[1] = 1.0 / (times[1] - times[0]);
      slope[0] = -slope[1];
    } else {
      three_point_slope(&times[first], times[j], slope);
    }
  }
  return sampling;
}

}  // namespace echopath
