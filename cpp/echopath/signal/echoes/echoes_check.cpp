#include "echopath/signal/echoes/echoes_check.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "echopath/base/errors.h"
#include "echopath/base/lanes/simd.h"

namespace echopath {
namespace {

ECHOPATH_INLINE void find_not_finite(const double* values, int64_t count, int64_t* bad) {
  int64_t found = 0;
  for (int64_t i = 0; i < count; ++i) found |= !(std::abs(values[i]) <= std::numeric_limits<double>::max());
  *bad = found;
}

void require_finite(const double* values, size_t count, const char* name) {
  int64_t found = 0;
  run_simd<find_not_finite>(values, static_cast<int64_t>(count), &found);
  if (!found) return;
  const double* bad = std::find_if(values, values + count, [](double value) { return !std::isfinite(value); });
  require(false, name, "must be finite", *bad);
}

void validate_sampling(const TimeSampling& sampling, int num_chirps) {
  const size_t chirps = static_cast<size_t>(num_chirps);
  require(sampling.num_rows >= 1, "sampling.num_rows", "must be at least 1", sampling.num_rows);
  require(sampling.order >= 1 && sampling.order <= sampling.num_rows, "sampling.order", "must be in [1, num_rows]",
          sampling.order);
  require(sampling.first_row.size() == chirps, "sampling.first_row", "must have one entry per chirp",
          sampling.first_row.size());
  const size_t weights = chirps * sampling.order;
  require(sampling.value.size() == weights, "sampling.value", "must have shape [chirps, order]", sampling.value.size());
  require(sampling.slope.size() == weights, "sampling.slope", "must have shape [chirps, order]", sampling.slope.size());
  for (const int node : sampling.first_row) {
    require(node >= 0 && node <= sampling.num_rows - sampling.order, "sampling.first_row",
            "must leave `order` rows in range", node);
  }
  require_finite(sampling.value.data(), weights, "sampling.value");
  require_finite(sampling.slope.data(), weights, "sampling.slope");
  for (const std::vector<double>* rows : {&sampling.second_derivative, &sampling.third_derivative}) {
    const char* name = rows == &sampling.second_derivative ? "sampling.second_derivative" : "sampling.third_derivative";
    require(rows->size() == sampling.second_derivative.size(), name, "must be empty only where the other is, values",
            rows->size());
    require(rows->empty() || rows->size() == weights, name, "must be empty or have shape [chirps, order]", rows->size());
    require_finite(rows->data(), rows->size(), name);
  }
}

}  // namespace

void require_echoes(const Echoes& block, int num_chirps, int num_groups) {
  validate_sampling(block.sampling, num_chirps);
  require(block.num_echoes >= 0, "num_echoes", "must not be negative", block.num_echoes);
  const size_t echoes = static_cast<size_t>(block.num_echoes);
  const size_t values = echoes * block.sampling.num_rows;
  require(block.delay.size() == values, "delay", "must have shape [num_rows, num_echoes]", block.delay.size());
  require(block.amplitude.size() == values, "amplitude", "must have shape [num_rows, num_echoes]", block.amplitude.size());
  require(block.group.empty() || block.group.size() == echoes, "group", "must be empty or have one entry per echo",
          block.group.size());
  for (const uint32_t group : block.group) {
    require(group < static_cast<uint32_t>(num_groups), "group", "must be below num_groups", group);
  }
  require_finite(block.delay.data(), values, "delay");
  require_finite(reinterpret_cast<const double*>(block.amplitude.data()), 2 * values, "amplitude");
}

}  // namespace echopath
