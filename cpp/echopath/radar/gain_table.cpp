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
  columns_ = GainAxis(azimuth_, period_);
  rows_ = GainAxis(elevation_, 0);
  lay_out();
  efficiency_ = integrate();
  if (scale == Scale::kMeanOfOne) {
    require(std::isfinite(efficiency_) && efficiency_ > 0.0, "gain",
            "must have a mean over the sphere that a double can hold", efficiency_);
    for (double& value : gain_) value /= efficiency_;
    set_field();
    lay_out();
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

// Lays the samples out so that the 4 x 4 of each cell stand in four rows of four.
void GainTable::lay_out() {
  const std::vector<GainAxis::Cell>&up = rows_.cells(), &along = columns_.cells();
  const size_t height = up.size() + 3, width = along.size() + 3;
  const auto index_of = [](const std::vector<GainAxis::Cell>& cells, size_t place) {
    const size_t cell = std::min(place, cells.size() - 1);
    return static_cast<size_t>(cells[cell].index[place - cell]);
  };
  for (std::vector<double>& part : parts_) part.clear();
  for (size_t row = 0; row < height; ++row) {
    for (size_t column = 0; column < width; ++column) {
      const std::complex<double> sample = field_[index_of(up, row) * azimuth_.size() + index_of(along, column)];
      parts_[0].push_back(sample.real());
      if (!phase_.empty()) parts_[1].push_back(sample.imag());
    }
  }
  lit_cells_.clear();
  for (size_t row = 0; row < up.size(); ++row) {
    for (size_t column = 0; column < along.size(); ++column) {
      const auto has_gain = [&](int i, int j) {
        return field_[up[row].index[i] * azimuth_.size() + along[column].index[j]] != 0.0;
      };
      lit_cells_.push_back(has_gain(1, 1) || has_gain(1, 2) || has_gain(2, 1) || has_gain(2, 2));
    }
  }
}

// Returns the cell of an azimuth, which it brings onto the table; none beyond.
std::optional<size_t> GainTable::find_column(double& azimuth) const {
  const double begin = azimuth_.front(), end = period_ ? begin + kTwoPi : azimuth_.back();
  azimuth -= kTwoPi * std::floor((azimuth - begin) / kTwoPi);  // in [begin, begin + 2 pi]
  // A direction on the first or last azimuth must not fall off the table by rounding.
  if (!(azimuth <= end)) {
    if (azimuth <= end + kAngleTolerance) azimuth = end;
    else if (azimuth >= begin + kTwoPi - kAngleTolerance) azimuth = begin;
    else return std::nullopt;
  }
  return columns_.cell_at(azimuth);
}

std::optional<size_t> GainTable::find_row(double& elevation) const {
  const bool is_there =
      elevation >= elevation_.front() - kAngleTolerance && elevation <= elevation_.back() + kAngleTolerance;
  if (!is_there) return std::nullopt;
  elevation = std::clamp(elevation, elevation_.front(), elevation_.back());
  return rows_.cell_at(elevation);
}

std::complex<double> GainTable::field_at(double azimuth, double elevation) const {
  const std::optional<size_t> row = find_row(elevation), column = find_column(azimuth);
  if (!row || !column || !lit_cells_[*row * columns_.cells().size() + *column]) return 0.0;
  const std::array<double, 4> of_rows = rows_.cells()[*row].weights(elevation),
                              of_columns = columns_.cells()[*column].weights(azimuth);
  const size_t width = columns_.cells().size() + 3, first = *row * width + *column;
  const auto sum = [&](const std::vector<double>& part) {
    std::array<double, 4> lines{};
    for (size_t i = 0; i < 4; ++i)
      for (size_t j = 0; j < 4; ++j) lines[j] += of_rows[i] * part[first + i * width + j];
    return lines[0] * of_columns[0] + lines[1] * of_columns[1] + lines[2] * of_columns[2] + lines[3] * of_columns[3];
  };
  return {sum(parts_[0]), parts_[1].empty() ? 0.0 : sum(parts_[1])};
}

std::complex<double> GainTable::field(const Vec3& direction) const {
  return field_at(std::atan2(direction.y(), direction.x()), std::asin(std::clamp(direction.z(), -1.0, 1.0)));
}

// Uses three Gauss points per cell and axis, exact up to the fifth degree; the squared cubic has the sixth.
double GainTable::integrate() const {
  const double node[3] = {-std::sqrt(0.6), 0.0, std::sqrt(0.6)}, weight[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  double sum = 0.0;
  for (const GainAxis::Cell& row : rows_.cells()) {
    for (const GainAxis::Cell& column : columns_.cells()) {
      for (int i = 0; i < 3; ++i) {
        const double elevation = row.begin + 0.5 * row.step * (1.0 + node[i]);
        for (int j = 0; j < 3; ++j) {
          const double azimuth = column.begin + 0.5 * column.step * (1.0 + node[j]);
          sum +=
              weight[i] * weight[j] * row.step * column.step * std::cos(elevation) * std::norm(field_at(azimuth, elevation));
        }
      }
    }
  }
  return sum / (4.0 * kPi);
}

bool GainTable::all_cells_in_front() const {
  const auto in_front = [](double azimuth) { return std::cos(azimuth) >= -kAngleTolerance; };
  const size_t num_columns = columns_.cells().size();
  for (size_t cell = 0; cell < lit_cells_.size(); ++cell) {
    if (!lit_cells_[cell]) continue;
    const auto& [left, step, index, slopes] = columns_.cells()[cell % num_columns];
    if (!in_front(left) || !in_front(left + 0.5 * step) || !in_front(left + step)) return false;
  }
  return true;
}

}  // namespace echopath
