#include "echopath/spectrum/array/virtual_array.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "echopath/spectrum/array/array_grid.h"

namespace echopath {
namespace {

constexpr double kMinSpacing = 0.2;  // wavelengths
constexpr double kLeastMean = 0.1;   // length of the mean of the antennas' boresights in the xy-plane

// Returns the azimuth in rad of the mean boresight; 0 where the antennas look up, or to all sides.
double boresight_azimuth(const Radar& radar) {
  const Vec3 sum = sum_of_boresights(radar.transmitters) + sum_of_boresights(radar.receivers);
  const auto num_antennas = static_cast<double>(radar.transmitters.size() + radar.receivers.size());
  return std::hypot(sum.x(), sum.y()) < kLeastMean * num_antennas ? 0.0 : std::atan2(sum.y(), sum.x());
}

std::vector<Vec3> sums_of_positions(const Radar& radar) {
  std::vector<Vec3> positions;
  for (const Antenna& transmitter : radar.transmitters) {
    for (const Antenna& receiver : radar.receivers) positions.push_back(transmitter.position + receiver.position);
  }
  return positions;
}

void take_mean_position(VirtualElement& element, const std::vector<Vec3>& positions) {
  element.position.setZero();
  for (const int channel : element.channels) element.position += positions[channel];
  element.position /= static_cast<double>(element.channels.size());
}

// Each channel joins the first element whose first channel is near.
std::vector<VirtualElement> merged(const std::vector<Vec3>& positions, double tolerance) {
  std::vector<VirtualElement> elements;
  for (size_t channel = 0; channel < positions.size(); ++channel) {
    const auto near = std::ranges::find_if(elements, [&](const VirtualElement& element) {
      return (positions[element.channels.front()] - positions[channel]).norm() <= tolerance;
    });
    VirtualElement& element = near != elements.end() ? *near : elements.emplace_back();
    element.channels.push_back(static_cast<int>(channel));
  }
  for (VirtualElement& element : elements) take_mean_position(element, positions);
  return elements;
}

// Sorts elements by row and column and merges those at one point of the grid.
void sort_by_grid(VirtualArray& array) {
  const auto cell = [](const VirtualElement& element) { return std::pair(element.row, element.column); };
  std::ranges::stable_sort(array.elements, [&](const auto& a, const auto& b) { return cell(a) < cell(b); });
  std::vector<VirtualElement> sorted;
  for (VirtualElement& element : array.elements) {
    if (sorted.empty() || cell(sorted.back()) != cell(element)) {
      sorted.push_back(std::move(element));
      continue;
    }
    std::vector<int>& channels = sorted.back().channels;
    channels.insert(channels.end(), element.channels.begin(), element.channels.end());
    std::ranges::sort(channels);
    take_mean_position(sorted.back(), array.positions);
  }
  array.elements = std::move(sorted);
}

void put_on_grid(VirtualArray& array) {
  std::vector<Vec3> points;
  for (const VirtualElement& element : array.elements) points.push_back(element.position);
  const auto fit = fit_grid(points, kArrayTolerance * array.wavelength, kMinSpacing * array.wavelength);
  if (!fit) return;
  array.grid = fit->grid;
  for (size_t i = 0; i < points.size(); ++i) {
    array.elements[i].row = fit->row[i];
    array.elements[i].column = fit->column[i];
  }
  sort_by_grid(array);
}

}  // namespace

Vec3 VirtualArray::centre() const {
  const auto add = [](const Vec3& sum, const VirtualElement& element) -> Vec3 { return sum + element.position; };
  return std::accumulate(elements.begin(), elements.end(), Vec3(Vec3::Zero()), add) / static_cast<double>(elements.size());
}

std::vector<std::pair<int, int>> VirtualArray::gaps() const {
  std::vector<std::pair<int, int>> missing;
  if (!grid) return missing;
  auto next = elements.begin();
  for (int row = 0; row < grid->num_rows; ++row) {
    for (int column = 0; column < grid->num_columns; ++column) {
      if (next != elements.end() && next->row == row && next->column == column) {
        ++next;
      } else {
        missing.emplace_back(row, column);
      }
    }
  }
  return missing;
}

int VirtualArray::num_overlaps() const { return static_cast<int>(positions.size() - elements.size()); }

Vec3 VirtualArray::extent() const {
  Vec3 low = positions.front(), high = positions.front();
  for (const Vec3& position : positions) {
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
  }
  return high - low;
}

VirtualArray virtual_array(const Radar& radar) {
  radar.validate();
  VirtualArray array;
  array.num_transmitters = static_cast<int>(radar.transmitters.size());
  array.num_receivers = static_cast<int>(radar.receivers.size());
  array.wavelength = radar.waveform.wavelength();
  array.positions = sums_of_positions(radar);
  array.boresight = boresight_azimuth(radar);
  arrange_elements(array);
  return array;
}

void arrange_elements(VirtualArray& array) {
  array.elements = merged(array.positions, kArrayTolerance * array.wavelength);
  array.grid.reset();
  put_on_grid(array);
}

}  // namespace echopath
