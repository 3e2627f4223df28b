#include "echopath/spectrum/cfar/cfar.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "echopath/base/memory/recent_results.h"
#include "echopath/base/text/streamed.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/spectrum/array/covering_directions.h"
#include "echopath/spectrum/array/tdm.h"
#include "echopath/spectrum/cfar/beam_maps.h"
#include "echopath/spectrum/cfar/training_halves.h"
#include "echopath/spectrum/cfar/training_power.h"

namespace echopath {
namespace {

constexpr int kTrainingVelocity = 4, kTrainingRange = 8;  // of an unpadded map
constexpr size_t kKeptDesigns = 64;

struct HalfWidths {
  int guard = 0, training = 0;
};

// Returns the half widths along one axis. Guard cells without room for training cells beyond them are of no use.
HalfWidths half_widths(std::optional<int> guard, std::optional<int> training, int lobe, int wanted, int64_t num_cells) {
  HalfWidths widths{guard.value_or(lobe), training.value_or(0)};
  if (!training) {
    const int64_t room = (num_cells - 1) / 2 - widths.guard;
    widths.training = static_cast<int>(std::clamp<int64_t>(room, 0, wanted));
  }
  if (!guard && widths.training == 0) widths.guard = 0;
  return widths;
}

// Computing factors takes a tenth of a second, for large windows several seconds; the frames of a data set share them.
CfarFactors kept_factors(const CfarDesign& design, Job* job) {
  using Recent = RecentResults<CfarDesign, CfarFactors>;
  static Recent& recent = *new Recent(kKeptDesigns);  // never destroyed: threads may outlive what is static
  return recent.get(design, [&] { return cfar_factors(design, job); });
}

struct Found {
  int64_t range;
  double noise;
};

class Detector {
 public:
  // `power` [V, R] is the result's where noise is alike in all cells.
  Detector(const CfarResult& result, const std::vector<double>& power)
      : result_(result), power_(power), training_(power, result.num_velocities, result.num_ranges, result.design.cells) {
    const CfarMethod method = result.design.method;
    if (method == CfarMethod::kGreatestOf || method == CfarMethod::kSmallestOf)
      halves_.emplace(power, result.num_velocities, result.num_ranges, result.design.cells);
  }

  // Prepares a row; call it once for each velocity before any row is asked for.
  void prepare_row(int64_t velocity) {
    if (result_.design.method == CfarMethod::kCellAveraging) training_.prepare_row(velocity);
    if (halves_) halves_->prepare_row(velocity);
  }

  // Returns the cells of a row above their thresholds.
  std::vector<Found> row(int64_t velocity) const {
    switch (result_.design.method) {
      case CfarMethod::kCellAveraging: return averaged(velocity);
      case CfarMethod::kOrderedStatistic: return ordered(velocity);
      case CfarMethod::kGreatestOf: return halved(velocity, [](double a, double b) { return std::max(a, b); });
      case CfarMethod::kSmallestOf: return halved(velocity, [](double a, double b) { return std::min(a, b); });
    }
    throw std::logic_error("unknown CFAR method");
  }

 private:
  double factor(int64_t range) const {
    const int64_t reach = result_.design.cells.reach_range();
    return result_.factors.factor[std::min({range, result_.num_ranges - 1 - range, reach})];
  }

  std::vector<Found> averaged(int64_t velocity) const {
    const double* power = power_.data() + velocity * result_.num_ranges;
    const double share = 1.0 / static_cast<double>(result_.design.cells.num_training());
    std::vector<double> sum(result_.num_ranges);
    training_.sums(velocity, sum.data());
    std::vector<Found> found;
    for (int64_t r = 0; r < result_.num_ranges; ++r) {
      if (power[r] > factor(r) * share * sum[r]) found.push_back({r, share * sum[r]});
    }
    return found;
  }

  std::vector<Found> ordered(int64_t velocity) const {
    const double* power = power_.data() + velocity * result_.num_ranges;
    const int64_t order = result_.design.order();
    std::vector<Found> found;
    for (int64_t r = 0; r < result_.num_ranges; ++r) {
      if (!training_.is_order_below(velocity, r, order, power[r] / factor(r))) continue;
      found.push_back({r, training_.ordered(velocity, r, order) / result_.factors.statistic});
    }
    return found;
  }

  template <class Choose>
  std::vector<Found> halved(int64_t velocity, Choose choose) const {
    const double* power = power_.data() + velocity * result_.num_ranges;
    const double share = 1.0 / static_cast<double>(result_.design.cells.num_in_half());
    std::vector<Found> found;
    std::vector<double> first(result_.num_ranges), second(result_.num_ranges);
    halves_->sums(velocity, {first.data(), second.data()});
    for (int64_t r = 0; r < result_.num_ranges; ++r) {
      const double statistic = share * choose(first[r], second[r]);
      if (power[r] > factor(r) * statistic) found.push_back({r, statistic / result_.factors.statistic});
    }
    return found;
  }

  const CfarResult& result_;
  const std::vector<double>& power_;
  TrainingPower training_;
  std::optional<TrainingHalves> halves_;  // of the methods that compare them
};

// Returns the powers of rows of ranges, each over that of the noise at its range.
std::vector<double> over_noise(std::vector<double> power, const std::vector<double>& noise_shape) {
  for (size_t cell = 0; cell < power.size(); ++cell) power[cell] /= noise_shape[cell % noise_shape.size()];
  return power;
}

void require_noise_shape(const std::vector<double>& noise_shape, int64_t num_ranges) {
  require(std::ssize(noise_shape) == num_ranges, "noise_shape",
          "must have a value for each range, " + std::to_string(num_ranges), noise_shape.size());
  for (const double level : noise_shape)
    require(std::isfinite(level) && level > 0.0, "noise_shape", "must have finite values above 0", level);
}

// Holds a cell above its threshold, by its place in a map [V, R].
struct FoundCell {
  int64_t place;
  double noise;
};

// Returns the cells of a map of powers [V, R] above their thresholds, ascending.
std::vector<FoundCell> find_in(const CfarResult& result, const std::vector<double>& given,
                               const std::vector<double>& noise_shape, Job* job) {
  const bool is_shaped = !noise_shape.empty();
  const std::vector<double> shaped = is_shaped ? over_noise(given, noise_shape) : std::vector<double>();
  const std::vector<double>& power = is_shaped ? shaped : given;
  Detector detector(result, power);
  parallel_for(result.num_velocities, [&](int64_t v) { detector.prepare_row(v); });
  std::vector<std::vector<Found>> rows(result.num_velocities);
  parallel_for(result.num_velocities, [&](int64_t v) { rows[v] = detector.row(v); }, job);
  std::vector<FoundCell> cells;
  for (int64_t v = 0; v < result.num_velocities; ++v) {
    for (const Found& found : rows[v]) {
      const double level = is_shaped ? noise_shape[found.range] : 1.0;
      cells.push_back({v * result.num_ranges + found.range, found.noise * level});
    }
  }
  return cells;
}

void require_finite(const std::vector<double>& power) {
  for (const double value : power) {
    require(std::isfinite(value), "spectrum", "must have values whose power is finite", value);
  }
}

void detect_in_sum(CfarResult& result, const RangeDoppler& map, const std::vector<double>& noise_shape, Job* job) {
  result.power = mean_power(map, job);
  require_finite(result.power);
  if (job) job->start(result.num_velocities);
  for (const FoundCell& cell : find_in(result, result.power, noise_shape, job)) {
    result.cells.push_back({cell.place / result.num_ranges, cell.place % result.num_ranges});
    result.noise.push_back(cell.noise);
  }
}

void require_rate_of_beams(double false_alarm_rate, int64_t num_beams) {
  const double least = kLeastRate * static_cast<double>(num_beams);
  require(false_alarm_rate >= least, "false_alarm_rate",
          streamed("must be at least ", least, " for the ", num_beams, " beams of the array"), false_alarm_rate);
}

// Holds, for a cell that was found in some beam, the strongest of these.
struct InBeam {
  int64_t beam = -1;
  double power = 0.0, noise = 0.0;
};

void detect_in_beams(CfarResult& result, const BeamMaps& maps, const std::vector<double>& noise_shape, Job* job) {
  result.num_beams = maps.num_beams();
  result.power.assign(result.num_velocities * result.num_ranges, 0.0);
  std::vector<InBeam> best(result.power.size());
  const int64_t num_turns = (result.num_beams + maps.num_together() - 1) / maps.num_together();
  if (job) job->start((num_turns + result.num_beams) * result.num_velocities);
  for (int64_t first = 0; first < result.num_beams; first += maps.num_together()) {
    const auto powers = maps.powers(first, std::min(maps.num_together(), result.num_beams - first), job);
    for (size_t i = 0; i < powers.size(); ++i) {
      require_finite(powers[i]);
      std::ranges::transform(result.power, powers[i], result.power.begin(),
                             [](double a, double b) { return std::max(a, b); });
      for (const FoundCell& cell : find_in(result, powers[i], noise_shape, job)) {
        const double power = powers[i][cell.place];
        if (power > best[cell.place].power) best[cell.place] = {first + static_cast<int64_t>(i), power, cell.noise};
      }
    }
  }
  for (size_t place = 0; place < best.size(); ++place) {
    if (best[place].beam < 0) continue;
    const int64_t cell = static_cast<int64_t>(place);
    result.cells.push_back({cell / result.num_ranges, cell % result.num_ranges});
    result.noise.push_back(best[place].noise);
    result.beams.push_back(maps.direction(best[place].beam));
    result.power[place] = best[place].power;
  }
}

}  // namespace

void check_beams(const Radar& radar, double false_alarm_rate) {
  radar.validate();
  require_rate_of_beams(false_alarm_rate, std::ssize(covering_directions(virtual_array(radar))));
}

CfarDesign cfar_design(const RangeDoppler& map, const Radar& radar, const CfarOptions& options) {
  radar.validate();
  require_map_of(map, radar);
  const ChirpSequence& waveform = radar.waveform;
  CfarDesign design{
      options.method,
      options.false_alarm_rate,
      options.rank,
      {},
      {map.window, waveform.num_chirps, waveform.num_samples, map.zero_pad, map.num_transmitters * map.num_receivers}};
  const int velocity_lobe = main_lobe_cells(map.window.velocity, waveform.num_chirps, map.zero_pad);
  const int range_lobe = main_lobe_cells(map.window.range, waveform.num_samples, map.zero_pad);
  const auto velocity = half_widths(options.guard_velocity, options.training_velocity, velocity_lobe,
                                    kTrainingVelocity * map.zero_pad, std::ssize(map.velocity));
  const auto range = half_widths(options.guard_range, options.training_range, range_lobe, kTrainingRange * map.zero_pad,
                                 std::ssize(map.range));
  design.cells = {velocity.guard, range.guard, velocity.training, range.training};
  const bool is_asked_for = options.training_velocity || options.training_range;
  require(is_asked_for || design.cells.num_training() > 0, "spectrum",
          "must have cells beside the main lobe of its window, which tell the noise (more samples or chirps, or a \"rect\" "
          "window), cells of velocity x range",
          streamed(map.velocity.size(), " x ", map.range.size()));
  design.cells.validate(std::ssize(map.velocity), std::ssize(map.range));
  design.validate();
  return design;
}

CfarResult cfar(const RangeDoppler& map, const Radar& radar, const CfarOptions& options, Job* job) {
  CfarResult result;
  result.design = cfar_design(map, radar, options);
  result.num_velocities = std::ssize(map.velocity);
  result.num_ranges = std::ssize(map.range);
  if (!options.noise_shape.empty()) require_noise_shape(options.noise_shape, result.num_ranges);
  if (!options.beams) {
    result.factors = kept_factors(result.design, job);
    detect_in_sum(result, map, options.noise_shape, job);
    return result;
  }
  const BeamMaps maps(map, radar);
  CfarDesign of_beam = result.design;
  of_beam.noise.num_channels = 1;
  require_rate_of_beams(options.false_alarm_rate, maps.num_beams());
  of_beam.false_alarm_rate /= static_cast<double>(maps.num_beams());
  result.factors = kept_factors(of_beam, job);
  detect_in_beams(result, maps, options.noise_shape, job);
  return result;
}

}  // namespace echopath
