#include "echopath/spectrum/angle/estimate_angles.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <Eigen/Eigenvalues>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/spectrum/angle/beam_source.h"

namespace echopath {
namespace {

constexpr int kMaxPeaks = 64;
constexpr int kNarrowings = 7;        // of the stencil, each behind a short step
constexpr double kNarrowing = 0.225;  // factor of each: 3e-5 of a step of the grid at the end
constexpr double kMiddle = 0.5;       // stencils, up to which a step is short
constexpr double kLongest = 4.0;      // stencils, of a step to the top of a paraboloid
constexpr int kMaxSteps = 100;        // from which on it narrows with each, wherever it is
// Of a peak's power the grid has this share at least, cos(pi/8)^2 along each angle, of an array of four corners whose beams
// lie an eighth of their width beside the directions of the grid: its highest top may lead to a lower peak than others.
constexpr double kLeastOnGrid = 0.72;
constexpr double kLeastAfterAStep = 0.95;                     // the share that the first step from there finds
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
      : source_(source), angles_(angles), options_(options),
        beams_(source.array(), beam_directions(source.array(), angles)) {}

  // place_of(fold) is where the echo lies if its velocity is so many spans of the axis beyond that which is shown.
  template <class PlaceOf>
  CellPeaks find(const Cell& cell, const PlaceOf& place_of) const {
    CellPeaks best;
    for (int k = 0; k <= 2 * options_.folds; ++k) {
      const int fold = k % 2 == 0 ? -k / 2 : (k + 1) / 2;  // 0, 1, -1, 2, ...: a tie goes to the slowest
      CellPeaks found{fold, peaks(source_.cell(cell[0], cell[1], place_of(fold)))};
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
    for (const int64_t top : tops) {
      const bool is_full = std::ssize(found) >= options_.max_peaks;
      const double least = is_full ? found[options_.max_peaks - 1].power : 0.0;  // of the weakest that is asked for
      if (power[top] < kLeastOnGrid * least) break;
      const Eigen::Array2d step = steps(top);
      Peak peak = at(top, power[top]);
      if (is_full) climb(beam, peak, step);
      if (peak.power < kLeastAfterAStep * least) continue;
      peak = refined(beam, peak, step);
      const auto same = std::ranges::find_if(found, [&](const Peak& other) { return is_one(peak, other, step); });
      if (same == found.end()) found.push_back(peak);
      else if (peak.power > same->power) *same = peak;
      std::ranges::stable_sort(found, std::greater(), &Peak::power);
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

  // Returns whether two peaks are within a step of the grid: tops along one beam that lies aslant lead to one.
  static bool is_one(const Peak& a, const Peak& b, const Eigen::Array2d& step) {
    const Eigen::Array2d apart(std::remainder(a.azimuth - b.azimuth, kTwoPi), a.elevation - b.elevation);
    return (apart.abs() <= step).all();
  }

  // Narrows the stencil once the top is near: narrowed on the way there, it would stop short of it.
  Peak refined(const CellBeam& beam, Peak peak, Eigen::Array2d stencil) const {
    for (int step = 0, narrowings = 0; narrowings < kNarrowings; ++step) {
      const Peak before = peak;
      climb(beam, peak, stencil);
      const Eigen::Array2d moved(peak.azimuth - before.azimuth, peak.elevation - before.elevation);
      if (step < kMaxSteps && (moved.abs() > kMiddle * stencil).any()) continue;
      stencil *= kNarrowing;
      ++narrowings;
    }
    return peak;
  }

  Peak at(int64_t d, double power) const {
    return {angles_.azimuth[d % num_azimuths()], angles_.elevation[d / num_azimuths()], power};
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

  // Moves to the highest of the peak, its neighbours on the stencil, and the top of the paraboloid through them, or, where
  // that is no higher, half way to it and so on: aslant, a beam is longer than along azimuth and elevation, and bent.
  void climb(const CellBeam& beam, Peak& peak, const Eigen::Array2d& stencil) const {
    const Peak centre = peak;
    const auto visit = [&](double i, double k) {
      const Peak here = beside(beam, centre, i * stencil[0], k * stencil[1]);
      if (here.power > peak.power) peak = here;
      return height(here);
    };
    const double top = height(centre);
    // These are the slope along an angle, or along both, and the second derivative, in stencils.
    const auto slopes = [&](double i, double k) {
      const double before = visit(-i, -k), behind = visit(i, k);
      return std::pair{0.5 * (behind - before), before - 2.0 * top + behind};
    };
    const bool has_azimuth = stencil[0] > 0.0, has_elevation = stencil[1] > 0.0;
    const auto [x, xx] = has_azimuth ? slopes(1, 0) : std::pair{0.0, 0.0};
    const auto [y, yy] = has_elevation ? slopes(0, 1) : std::pair{0.0, 0.0};
    const double xy = has_azimuth && has_elevation ? 0.5 * (slopes(1, 1).second - xx - yy) : 0.0;
    Eigen::Vector2d to_top = uphill(Eigen::Vector2d(x, y), (Eigen::Matrix2d() << xx, xy, xy, yy).finished());
    while (visit(to_top[0], to_top[1]) <= top && to_top.lpNorm<Eigen::Infinity>() > kMiddle) to_top *= 0.5;
  }

  // Returns Newton's step to the top of a paraboloid of this slope and these second derivatives, in stencils: along each of
  // its principal axes the slope over the size of the second derivative, so that it goes uphill where there is no top, and
  // at most kLongest.
  static Eigen::Vector2d uphill(const Eigen::Vector2d& slope, const Eigen::Matrix2d& derivatives) {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
    axes.computeDirect(derivatives);
    const Eigen::Array2d along = axes.eigenvectors().transpose() * slope;
    const Eigen::Array2d longest = along.sign() * kLongest, step = along / axes.eigenvalues().array().abs();
    return axes.eigenvectors() * (step.abs() < kLongest).select(step, longest).matrix();
  }

  // Returns what is a parabola about a peak: beside one echo Capon's power falls as (e + d^2)^-2 at a distance d.
  double height(const Peak& peak) const {
    return options_.beams.method == BeamMethod::kCapon ? -1.0 / std::sqrt(peak.power) : peak.power;
  }

  Peak beside(const CellBeam& beam, Peak peak, double across, double up) const {
    peak.azimuth = std::clamp(peak.azimuth + across, angles_.azimuth.front(), angles_.azimuth.back());
    peak.elevation = std::clamp(peak.elevation + up, angles_.elevation.front(), angles_.elevation.back());
    const Vec3 toward = direction(peak.azimuth, peak.elevation);
    peak.power = beam.power(BeamKernel(source_.array(), {toward}))[0];
    return peak;
  }

  // Returns the peaks that are asked for of those found, which are in order.
  std::vector<Peak> strongest(std::vector<Peak> found) const {
    if (std::ssize(found) > options_.max_peaks) found.resize(options_.max_peaks);
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
  require(options.range.empty() || options.range.size() == cells.size(), "range", "must have one value for each cell",
          options.range.size());
  const ChirpSequence& waveform = radar.waveform;
  const double span = 2.0 * waveform.max_velocity(radar.num_slots());
  const double shown_per_velocity = waveform.centre_frequency() / waveform.slope();  // s, range that is shown
  const PeakSearch search(source, angles, options);
  std::vector<CellPeaks> found(cells.size());
  if (job) job->start(std::ssize(cells));
  const auto search_cell = [&](int64_t i) {
    const double beside = (velocity_of(i) - map.velocity[cells[i][0]]) / span;
    found[i] = search.find(cells[i], [&](int fold) {
      EchoPlace place{fold + beside, {}};
      if (!options.range.empty()) place.range = options.range[i] - shown_per_velocity * (velocity_of(i) + fold * span);
      return place;
    });
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
