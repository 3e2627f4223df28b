#include "echopath/radar/gain_table.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/text/streamed.h"

namespace echopath {
namespace {

constexpr double kAngleTolerance = 1e-6;  // rad, degrees with five written digits
constexpr double kNothing = 1e-12;        // of the peak: what rounding leaves of a zero
constexpr double kNearPole = 0.05;        // cosine of the elevation
constexpr double kSeamTolerance = 1e-3;   // of the peak: samples one turn apart are the same direction

void require_axis(const std::vector<double>& values, const std::string& name) {
  require(values.size() >= 2, name, "must have at least 2 values", values.size());
  for (size_t i = 0; i < values.size(); ++i) {
    require(std::isfinite(values[i]), name, "must be finite", values[i]);
    require(i == 0 || values[i] > values[i - 1], name, "must ascend", values[i]);
  }
}

void require_samples(const std::vector<double>& values, size_t count, const std::string& name) {
  require(values.size() == count, name, "must have a value for each elevation and azimuth, " + std::to_string(count),
          values.size());
  for (const double value : values) require(std::isfinite(value), name, "must be finite", value);
}

// Returns such as "a mean of 1.2 (0.79 dB)".
std::string in_words(double mean) {
  return "a mean of " + with_digits(4, mean) + " (" + with_digits(4, 10.0 * std::log10(mean)) + " dB)";
}

// Computes cubic Hermite weights at x between at[1] and at[2]. Slopes come from parabolas through three samples; at an end
// (no sample before or behind) the cubic becomes the parabola through the other three.
void set_weights(const double at[4], bool has_before, bool has_behind, double x, double weight[4]) {
  const double step = at[2] - at[1], t = (x - at[1]) / step;
  const double secant[4] = {0.0, -1.0, 1.0, 0.0};          // times 1 / step
  double first[4] = {0, 0, 0, 0}, last[4] = {0, 0, 0, 0};  // slopes at both ends, times step
  if (has_before) {
    const double before = at[1] - at[0], sum = before + step;
    first[0] = -step / before * (step / sum);
    first[1] = step / before * (step / sum) - before / sum;
    first[2] = before / sum;
  }
  if (has_behind) {
    const double behind = at[3] - at[2], sum = behind + step;
    last[3] = step / behind * (step / sum);
    last[2] = behind / sum - step / behind * (step / sum);
    last[1] = -behind / sum;
  }
  for (int i = 0; i < 4; ++i) {
    if (!has_before) first[i] = has_behind ? 2.0 * secant[i] - last[i] : secant[i];
    if (!has_behind) last[i] = has_before ? 2.0 * secant[i] - first[i] : secant[i];
  }
  const double s = 1.0 - t;
  const double value[4] = {0.0, s * s * (1.0 + 2.0 * t), t * t * (3.0 - 2.0 * t), 0.0};
  for (int i = 0; i < 4; ++i) weight[i] = value[i] + t * s * (s * first[i] - t * last[i]);
}

}  // namespace

GainTable::GainTable(std::vector<double> azimuth, std::vector<double> elevation, std::vector<double> gain,
                     std::vector<double> phase, Scale scale)
    : azimuth_(std::move(azimuth)), elevation_(std::move(elevation)), gain_(std::move(gain)), phase_(std::move(phase)) {
  require_axis(azimuth_, "azimuth");
  require_axis(elevation_, "elevation");
  require(azimuth_.back() - azimuth_.front() <= kTwoPi + kAngleTolerance, "azimuth", "must cover at most 2 pi rad",
          azimuth_.back() - azimuth_.front());
  for (const double angle : {elevation_.front(), elevation_.back()}) {
    require(std::abs(angle) <= 0.5 * kPi + kAngleTolerance, "elevation", "must lie in [-pi/2, pi/2] rad", angle);
  }
  const size_t count = azimuth_.size() * elevation_.size();
  require_samples(gain_, count, "gain");
  if (!phase_.empty()) require_samples(phase_, count, "phase");
  for (const double value : gain_)
    require(value >= 0.0, "gain", "must not be negative: it is a ratio of powers, no dB", value);
  require(peak_gain() > 0.0, "gain", "must not be 0 everywhere", peak_gain());

  set_field();
  close_ring();
  efficiency_ = integrate();
  if (scale == Scale::kMeanOfOne) {
    require(std::isfinite(efficiency_) && efficiency_ > 0.0, "gain",
            "must have a mean over the sphere that a double can hold", efficiency_);
    for (double& value : gain_) value /= efficiency_;
    set_field();
    efficiency_ = integrate();
  }
  require(efficiency_ <= kLargestEfficiency, "gain",
          "must have a mean over the sphere of at most 1.02 (0.09 dB), as no antenna radiates more power than it is fed; "
          "normalize=True scales it to a mean of 1",
          in_words(efficiency_));
  dark_behind_ = all_cells_in_front();
  largest_field_ = most_beyond_samples() * std::sqrt(peak_gain());
  sharpness_ = find_sharpness();
}

void GainTable::set_field() {
  const double least = kNothing * peak_gain();
  field_.clear();
  for (size_t i = 0; i < gain_.size(); ++i) {
    field_.push_back(std::polar(gain_[i] < least ? 0.0 : std::sqrt(gain_[i]), phase_.empty() ? 0.0 : phase_[i]));
  }
}

AntennaGain GainTable::toward(const Vec3& direction) const {
  const std::complex<double> found = field(direction);
  return {std::norm(found), phase_.empty() ? 0.0 : std::arg(found)};
}

double GainTable::peak_gain() const { return *std::ranges::max_element(gain_); }

double GainTable::most_beyond_samples() const {
  const auto largest_ratio = [](const std::vector<double>& axis, double gap) {
    std::vector<double> steps;
    for (size_t i = 1; i < axis.size(); ++i) steps.push_back(axis[i] - axis[i - 1]);
    if (gap > kAngleTolerance) steps.insert(steps.end(), {gap, steps.front()});
    double ratio = 1.0;
    for (size_t i = 1; i < steps.size(); ++i) {
      ratio = std::max({ratio, steps[i] / steps[i - 1], steps[i - 1] / steps[i]});
    }
    return ratio;
  };
  const double gap = period_ ? azimuth_.front() + kTwoPi - azimuth_.back() : 0.0;
  return (4.0 + largest_ratio(azimuth_, gap)) * (4.0 + largest_ratio(elevation_, 0.0));
}

double GainTable::find_sharpness() const {
  const size_t columns = azimuth_.size();
  double steepest = 0.0;
  const auto add_slope = [&](size_t from, size_t to, double angle) {
    steepest = std::max(steepest, std::abs(std::abs(field_[to]) - std::abs(field_[from])) / angle);
  };
  for (size_t i = 0; i < field_.size(); ++i) {
    const size_t row = i / columns, column = i % columns;
    const double shrinks = std::cos(elevation_[row]);  // near a pole, where gains hardly differ, azimuths are close together
    if (column + 1 < columns && shrinks > kNearPole)
      add_slope(i, i + 1, shrinks * (azimuth_[column + 1] - azimuth_[column]));
    if (row + 1 < elevation_.size()) add_slope(i, i + columns, elevation_[row + 1] - elevation_[row]);
  }
  return kSlopeOfSharpness * steepest / std::sqrt(peak_gain());
}

void GainTable::close_ring() {
  const auto columns = static_cast<int>(azimuth_.size());
  double step = 0.0;
  for (size_t i = 1; i < azimuth_.size(); ++i) step = std::max(step, azimuth_[i] - azimuth_[i - 1]);
  const double gap = azimuth_.front() + kTwoPi - azimuth_.back();
  if (gap > step + kAngleTolerance || columns < 4) return;
  period_ = gap > kAngleTolerance ? columns : columns - 1;
  if (period_ == columns) return;
  const double bound = kSeamTolerance * peak_gain();
  for (size_t row = 0; row < elevation_.size(); ++row) {
    const double first = gain_[row * azimuth_.size()], last = gain_[(row + 1) * azimuth_.size() - 1];
    require(std::abs(first - last) <= bound, "gain", "must agree at azimuths a turn apart within 1e-3 of the peak",
            std::abs(first - last));
  }
}

double GainTable::azimuth_at(int column) const {
  if (period_ == 0) return azimuth_[column];
  const int turns = column < 0 ? -1 : column / period_;
  return azimuth_[column - turns * period_] + turns * kTwoPi;
}

size_t GainTable::sample(int row, int column) const {
  return static_cast<size_t>(row) * azimuth_.size() + static_cast<size_t>(column);
}

bool GainTable::find_azimuth(double azimuth, Stencil& out) const {
  const double begin = azimuth_.front();
  double turned = azimuth - kTwoPi * std::floor((azimuth - begin) / kTwoPi);  // in [begin, begin + 2 pi]
  const int columns = static_cast<int>(azimuth_.size()), cells = period_ ? period_ : columns - 1;
  const double end = period_ ? begin + kTwoPi : azimuth_.back();
  // A direction on the first or last azimuth must not fall off the table by rounding.
  if (turned > end) {
    if (turned <= end + kAngleTolerance) turned = end;
    else if (turned >= begin + kTwoPi - kAngleTolerance) turned = begin;
    else return false;
  }
  const auto above = std::upper_bound(azimuth_.begin(), azimuth_.begin() + std::min(cells, columns), turned);
  const int cell = std::clamp(static_cast<int>(above - azimuth_.begin()) - 1, 0, cells - 1);
  double at[4] = {0.0, 0.0, 0.0, 0.0};
  const bool has_before = period_ > 0 || cell > 0, has_behind = period_ > 0 || cell + 2 < columns;
  for (int i = 0; i < 4; ++i) {
    const bool exists = (i > 0 || has_before) && (i < 3 || has_behind);
    const int column = exists ? cell + i - 1 : cell;
    at[i] = azimuth_at(column);
    out.index[i] = period_ ? (column + period_) % period_ : column;
  }
  set_weights(at, has_before, has_behind, turned, out.weight);
  return true;
}

bool GainTable::find_elevation(double elevation, Stencil& out) const {
  if (elevation < elevation_.front() - kAngleTolerance || elevation > elevation_.back() + kAngleTolerance) return false;
  const double inside = std::clamp(elevation, elevation_.front(), elevation_.back());
  const auto above = std::ranges::upper_bound(elevation_, inside);
  const int rows = static_cast<int>(elevation_.size());
  const int cell = std::clamp(static_cast<int>(above - elevation_.begin()) - 1, 0, rows - 2);
  double at[4] = {0.0, 0.0, 0.0, 0.0};
  for (int i = 0; i < 4; ++i) {
    out.index[i] = std::clamp(cell + i - 1, 0, rows - 1);
    at[i] = elevation_[out.index[i]];
  }
  set_weights(at, cell > 0, cell + 2 < rows, inside, out.weight);
  return true;
}

std::complex<double> GainTable::field_at(double azimuth, double elevation) const {
  Stencil along, up;
  if (!find_elevation(elevation, up) || !find_azimuth(azimuth, along)) return 0.0;
  if (!has_gain(up.index[1], along.index[1])) return 0.0;
  std::complex<double> sum = 0.0;
  for (int row = 0; row < 4; ++row) {
    std::complex<double> line = 0.0;
    for (int column = 0; column < 4; ++column) {
      line += along.weight[column] * field_[sample(up.index[row], along.index[column])];
    }
    sum += up.weight[row] * line;
  }
  return sum;
}

std::complex<double> GainTable::field(const Vec3& direction) const {
  return field_at(std::atan2(direction.y(), direction.x()), std::asin(std::clamp(direction.z(), -1.0, 1.0)));
}

// Uses three Gauss points per cell and axis, exact up to the fifth degree; the squared cubic has the sixth.
double GainTable::integrate() const {
  const double node[3] = {-std::sqrt(0.6), 0.0, std::sqrt(0.6)}, weight[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  const int cells = period_ ? period_ : static_cast<int>(azimuth_.size()) - 1;
  double sum = 0.0;
  for (size_t row = 0; row + 1 < elevation_.size(); ++row) {
    const double up = elevation_[row + 1] - elevation_[row], middle = 0.5 * (elevation_[row + 1] + elevation_[row]);
    for (int column = 0; column < cells; ++column) {
      const double left = azimuth_at(column), along = azimuth_at(column + 1) - left;
      for (int i = 0; i < 3; ++i) {
        const double elevation = middle + 0.5 * up * node[i];
        for (int j = 0; j < 3; ++j) {
          const double azimuth = left + 0.5 * along * (1.0 + node[j]);
          sum += weight[i] * weight[j] * up * along * std::cos(elevation) * std::norm(field_at(azimuth, elevation));
        }
      }
    }
  }
  return sum / (4.0 * kPi);
}

bool GainTable::has_gain(int row, int column) const {
  const int next = period_ ? (column + 1) % period_ : column + 1;
  return field_[sample(row, column)] != 0.0 || field_[sample(row, next)] != 0.0 || field_[sample(row + 1, column)] != 0.0 ||
         field_[sample(row + 1, next)] != 0.0;
}

bool GainTable::all_cells_in_front() const {
  const auto in_front = [](double azimuth) { return std::cos(azimuth) >= -kAngleTolerance; };
  const int cells = period_ ? period_ : static_cast<int>(azimuth_.size()) - 1;
  for (int column = 0; column < cells; ++column) {
    const double left = azimuth_at(column), right = azimuth_at(column + 1);
    if (in_front(left) && in_front(right) && in_front(0.5 * (left + right))) continue;
    for (int row = 0; row + 1 < static_cast<int>(elevation_.size()); ++row) {
      if (has_gain(row, column)) return false;
    }
  }
  return true;
}

}  // namespace echopath
