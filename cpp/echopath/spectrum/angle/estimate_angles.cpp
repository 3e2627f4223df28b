#include "echopath/spectrum/angle/estimate_angles.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/spectrum/angle/beam_source.h"

namespace echopath {
namespace {

constexpr int kMaxPeaks = 64;
constexpr int kNarrowings = 7;        // of the stencil, each behind a round that has not left its middle
constexpr double kNarrowing = 0.225;  // factor of each: 3e-5 of a step of the grid at the end
constexpr double kMiddle = 0.5;       // of the stencil
constexpr int kMaxRounds = 100;       // beams that are longer than wide aslant take more than one for a stencil
constexpr double kApart = 0.01;       // of a step of the grid, within which two tops of the grid have led to one peak
constexpr double kMinPeakRange = 0.0, kMaxPeakRange = 200.0;  // dB

struct Peak {
  double azimuth, elevation, power;
};

struct CellPeaks {
  int fold = 0;
  std::vector<Peak> peaks;  // strongest first
};

// Searches the peaks of one cell.
class PeakSearch {
 public:
  PeakSearch(const BeamSource& source, const AngleGrid& angles, const EstimateOptions& options)
      : source_(source), angles_(angles), options_(options), beams_(steering_vectors(source.array(), angles)) {}

  // `beside`: by how much the echo is faster than its cell, in spans of the velocity axis.
  CellPeaks find(const Cell& cell, double beside) const {
    CellPeaks best;
    for (int k = 0; k <= 2 * options_.folds; ++k) {
      const int fold = k % 2 == 0 ? -k / 2 : (k + 1) / 2;  // 0, 1, -1, 2, ...: a tie goes to the slowest
      CellPeaks found{fold, peaks(source_.cell(cell[0], cell[1], fold + beside))};
      if (found.peaks.empty()) continue;
      // The margin is relative, because hypotheses that the array cannot tell apart differ by rounding.
      constexpr double kMargin = 1.0 + 1e-9;
      if (best.peaks.empty() || found.peaks[0].power > kMargin * best.peaks[0].power) best = std::move(found);
    }
    return best;
  }

 private:
  int64_t num_azimuths() const { return std::ssize(angles_.azimuth); }
  int64_t num_elevations() const { return std::ssize(angles_.elevation); }

  std::vector<Peak> peaks(const CellBeam& beam) const {
    const Eigen::VectorXd power = beam.power(beams_);
    std::vector<int64_t> tops;
    for (int64_t d = 0; d < power.size(); ++d) {
      if (is_top(power, d)) tops.push_back(d);
    }
    std::ranges::stable_sort(tops, [&](int64_t a, int64_t b) { return power[a] > power[b]; });
    std::vector<Peak> found;
    for (size_t i = 0; i < tops.size() && std::ssize(found) < options_.max_peaks; ++i) {
      const Peak peak = refined(beam, tops[i], power[tops[i]]);
      const Eigen::Array2d apart = kApart * steps(tops[i]);
      const auto is_peak = [&](const Peak& other) { return is_within(peak, other, apart); };
      if (std::ranges::none_of(found, is_peak)) found.push_back(peak);
    }
    return strongest(std::move(found));
  }

  // Returns whether a direction has power, no neighbour is higher, and none before it is as high.
  bool is_top(const Eigen::VectorXd& power, int64_t d) const {
    if (!(power[d] > 0.0)) return false;
    const int64_t row = d / num_azimuths(), column = d % num_azimuths();
    for (int64_t r = std::max<int64_t>(0, row - 1); r <= std::min(num_elevations() - 1, row + 1); ++r) {
      for (int64_t c = std::max<int64_t>(0, column - 1); c <= std::min(num_azimuths() - 1, column + 1); ++c) {
        const int64_t other = r * num_azimuths() + c;
        if (power[other] > power[d] || (power[other] == power[d] && other < d)) return false;
      }
    }
    return true;
  }

  // Climbs along azimuth and elevation in turn, and then along both at once: aslant, a beam is longer across them. The stencil
  // narrows once the top is within its middle: narrowed on the way there, it would stop short of it.
  Peak refined(const CellBeam& beam, int64_t d, double power) const {
    Peak peak{angles_.azimuth[d % num_azimuths()], angles_.elevation[d / num_azimuths()], power};
    Eigen::Array2d stencil = steps(d);
    for (int round = 0, narrowings = 0; narrowings < kNarrowings && round < kMaxRounds; ++round) {
      const Peak before = peak;
      climb(beam, peak, &Peak::azimuth, stencil[0], angles_.azimuth);
      climb(beam, peak, &Peak::elevation, stencil[1], angles_.elevation);
      if (stencil.minCoeff() > 0.0) climb_aslant(beam, peak, stencil[0], stencil[1]);
      if (!is_within(peak, before, kMiddle * stencil)) continue;
      stencil *= kNarrowing;
      ++narrowings;
    }
    return peak;
  }

  // Returns whether two peaks are no further from each other than `apart`, in azimuth and in elevation.
  static bool is_within(const Peak& a, const Peak& b, const Eigen::Array2d& apart) {
    return std::abs(a.azimuth - b.azimuth) <= apart[0] && std::abs(a.elevation - b.elevation) <= apart[1];
  }

  // Returns the steps of the grid about a direction in azimuth and elevation, rad.
  Eigen::Array2d steps(int64_t d) const {
    return {step(angles_.azimuth, d % num_azimuths()), step(angles_.elevation, d / num_azimuths())};
  }

  static double step(const std::vector<double>& axis, int64_t i) {
    if (axis.size() == 1) return 0.0;
    const int64_t last = std::ssize(axis) - 1;
    return std::max(i > 0 ? axis[i] - axis[i - 1] : 0.0, i < last ? axis[i + 1] - axis[i] : 0.0);
  }

  // Moves to the highest of the peak, its neighbours at +-step along one angle, and the top of the parabola through the
  // three.
  void climb(const CellBeam& beam, Peak& peak, double Peak::* angle, double step, const std::vector<double>& axis) const {
    if (step <= 0.0) return;
    const double centre = peak.*angle, low = height(at(beam, peak, angle, centre - step, axis));
    const double high = height(at(beam, peak, angle, centre + step, axis));
    const double second_difference = low - 2.0 * height(peak) + high;
    const double offset = second_difference < 0.0 ? 0.5 * step * (low - high) / second_difference : 0.0;
    for (const double shift : {-step, step, std::clamp(offset, -step, step)}) {
      const Peak candidate = at(beam, peak, angle, centre + shift, axis);
      if (candidate.power > peak.power) peak = candidate;
    }
  }

  // Moves to the top of the paraboloid through the peak and its neighbours at +-across and +-up, if that is higher.
  void climb_aslant(const CellBeam& beam, Peak& peak, double across, double up) const {
    const auto beside = [&](double i, double k) { return beside_peak(beam, peak, i * across, k * up); };
    const auto height_at = [&](double i, double k) { return height(beside(i, k)); };
    const double top = height(peak), left = height_at(-1, 0), right = height_at(1, 0);
    const double below = height_at(0, -1), above = height_at(0, 1);
    const double xx = left - 2.0 * top + right, yy = below - 2.0 * top + above;
    const double xy = 0.5 * (height_at(1, 1) + height_at(-1, -1) - left - right - below - above) + top;
    const double x = 0.5 * (right - left), y = 0.5 * (above - below), determinant = xx * yy - xy * xy;
    if (!(xx < 0.0) || !(determinant > 0.0)) return;
    const double i = (xy * y - yy * x) / determinant, k = (xy * x - xx * y) / determinant;
    const double longest = std::max({1.0, std::abs(i), std::abs(k)});
    const Peak candidate = beside(i / longest, k / longest);
    if (candidate.power > peak.power) peak = candidate;
  }

  // Returns what is a parabola about a peak: beside one echo Capon's power falls as (e + d^2)^-2 at a distance d.
  double height(const Peak& peak) const {
    return options_.beams.method == BeamMethod::kCapon ? -1.0 / std::sqrt(peak.power) : peak.power;
  }

  Peak at(const CellBeam& beam, Peak peak, double Peak::* angle, double value, const std::vector<double>& axis) const {
    peak.*angle = std::clamp(value, axis.front(), axis.back());
    return with_power(beam, peak);
  }

  Peak beside_peak(const CellBeam& beam, Peak peak, double across, double up) const {
    peak.azimuth = std::clamp(peak.azimuth + across, angles_.azimuth.front(), angles_.azimuth.back());
    peak.elevation = std::clamp(peak.elevation + up, angles_.elevation.front(), angles_.elevation.back());
    return with_power(beam, peak);
  }

  Peak with_power(const CellBeam& beam, Peak peak) const {
    const Vec3 toward = direction(peak.azimuth, peak.elevation);
    peak.power = beam.power(BeamKernel(steering_vectors(source_.array(), {toward})))[0];
    return peak;
  }

  std::vector<Peak> strongest(std::vector<Peak> found) const {
    std::ranges::stable_sort(found, std::greater(), &Peak::power);
    const double share = std::pow(10.0, -options_.peak_range_db / 10.0);
    while (!found.empty() && found.back().power < share * found.front().power) found.pop_back();
    return found;
  }

  const BeamSource& source_;
  const AngleGrid& angles_;
  const EstimateOptions& options_;
  const BeamKernel beams_;
};

}  // namespace

void EstimateOptions::validate(int num_slots) const {
  beams.validate();
  require(max_peaks >= 1 && max_peaks <= kMaxPeaks, "max_peaks", "must be in [1, 64]", max_peaks);
  require(peak_range_db >= kMinPeakRange && peak_range_db <= kMaxPeakRange, "peak_range_db", "must be in [0, 200]",
          peak_range_db);
  require(folds >= 0 && 2 * folds < std::max(2, num_slots), "folds",
          "must be at least 0 and less than half the number of slots in which transmitters take turns", folds);
  require(folds == 0 || beams.compensate, "folds", "needs the phase between slots to be compensated", folds);
}

AngleEstimates estimate_angles(const RangeDoppler& map, const Radar& radar, const std::vector<Cell>& cells,
                               const AngleGrid& angles, const EstimateOptions& options, Job* job) {
  angles.validate();
  options.validate(radar.takes_turns() ? radar.num_slots() : 1);  // codes leave no phase between slots
  require(options.folds == 0 || !map.is_tdm_compensated, "folds", "needs a map that was not compensated before",
          options.folds);
  const BeamSource source(map, radar, options.beams);
  require_cells_of(map, cells);
  require(options.velocity.empty() || options.velocity.size() == cells.size(), "velocity",
          "must have one value for each cell", options.velocity.size());
  const auto velocity_of = [&](size_t i) {
    return options.velocity.empty() ? map.velocity[cells[i][0]] : options.velocity[i];
  };
  const double span = 2.0 * radar.waveform.max_velocity(radar.num_slots());
  const PeakSearch search(source, angles, options);
  std::vector<CellPeaks> found(cells.size());
  if (job) job->start(std::ssize(cells));
  const auto search_cell = [&](int64_t i) {
    found[i] = search.find(cells[i], (velocity_of(i) - map.velocity[cells[i][0]]) / span);
  };
  parallel_for(std::ssize(cells), search_cell, job);

  const auto mean_of = [](const std::vector<Antenna>& antennas) { return mean_position(antennas, Transform::Identity()); };
  const Vec3 middle = 0.5 * (mean_of(radar.transmitters) + mean_of(radar.receivers));
  AngleEstimates result;
  for (size_t i = 0; i < cells.size(); ++i) {
    for (const Peak& peak : found[i].peaks) {
      const double range = map.range[cells[i][1]];
      result.cell.push_back(static_cast<int64_t>(i));
      result.range.push_back(range);
      result.velocity.push_back(velocity_of(i) + found[i].fold * span);
      result.azimuth.push_back(std::remainder(peak.azimuth, kTwoPi));
      result.elevation.push_back(peak.elevation);
      result.power.push_back(peak.power);
      result.points.push_back(middle + range * direction(peak.azimuth, peak.elevation));
    }
  }
  return result;
}

}  // namespace echopath
