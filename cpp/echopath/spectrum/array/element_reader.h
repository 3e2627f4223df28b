#pragma once
// Reads cells of a range-Doppler map as vectors over the elements of its virtual array.
#include <Eigen/Core>
#include <complex>
#include <cstdint>
#include <optional>
#include <vector>

#include "echopath/spectrum/array/virtual_array.h"
#include "echopath/spectrum/range_doppler.h"

namespace echopath {

// Tells whether channels that share an element are averaged or only the first is used.
enum class Overlaps { kAverage, kFirst };

// Says where an echo lies whose phases between transmitters are taken out.
struct EchoPlace {
  // Its velocity is that of the cell and 2 fold v_max, also where `fold` is not whole.
  double fold = 0.0;
  // Its range in m, by which phases of carriers are taken out in all cells that have some of the echo; none: by that of each
  // cell.
  std::optional<double> range;
};

// Reads snapshots. It keeps references to the map and the array.
class ElementReader {
 public:
  // `compensate` takes out the phase between TDM slots at the velocity of each cell, unless that has been done already.
  ElementReader(const RangeDoppler& map, const VirtualArray& array, const Radar& radar, Overlaps overlaps, bool compensate);
  int64_t num_elements() const { return std::ssize(first_) - 1; }
  int64_t num_velocities() const { return num_velocities_; }
  int64_t num_ranges() const { return num_ranges_; }

  // Reads ranges [first, first + count) of one velocity into values [elements, count], sqrt(W). The place of the echo has no
  // effect without `compensate`.
  void read(int64_t velocity, int64_t first, int64_t count, Eigen::Ref<Eigen::MatrixXcd> values,
            const EchoPlace& echo = {}) const;
  // Returns the weights [tx * rx] of the channels of a cell that give the sum over the elements with weights [elements].
  Eigen::VectorXcd channel_weights(int64_t velocity, int64_t range, const Eigen::VectorXcd& of_elements) const;

 private:
  std::complex<double> weight(int64_t entry, int64_t velocity, double fold) const;
  // Returns what takes out the phase of the carrier of a channel in a cell.
  std::complex<double> carrier(int64_t channel, int64_t range, const EchoPlace& echo) const;

  const RangeDoppler& map_;
  int64_t num_velocities_, num_ranges_;
  bool compensate_;
  std::vector<int64_t> first_;                 // [elements + 1] into channel_
  std::vector<int64_t> channel_;               // tx * num_receivers + rx
  std::vector<std::complex<double>> phasor_;   // [tx, V]
  std::vector<double> turns_of_carrier_;       // [tx] rad/m (tdm.h), empty: none
  std::vector<std::complex<double>> carrier_;  // [tx, R] at the ranges of the map, empty: 1
  std::vector<double> turns_of_fold_;          // [tx], by which an echo turns until the slot of a transmitter for each fold
};

}  // namespace echopath
