#include "echopath/spectrum/array/element_reader.h"

#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/spectrum/array/tdm.h"

namespace echopath {

using Complex = std::complex<double>;

ElementReader::ElementReader(const RangeDoppler& map, const VirtualArray& array, const Radar& radar, Overlaps overlaps,
                             bool compensate)
    : map_(map), num_velocities_(std::ssize(map.velocity)), num_ranges_(std::ssize(map.range)),
      compensate_(compensate && radar.takes_turns()), first_{0} {
  for (const VirtualElement& element : array.elements) {
    const auto end = overlaps == Overlaps::kFirst ? element.channels.begin() + 1 : element.channels.end();
    channel_.insert(channel_.end(), element.channels.begin(), end);
    first_.push_back(std::ssize(channel_));
  }
  if (!compensate_) return;
  const double period = radar.num_slots() * radar.waveform.mean_interval();
  for (const double delay : slot_delays(radar)) turns_of_fold_.push_back(delay / period);
  turns_of_carrier_ = carrier_turns(radar);
  if (map.is_tdm_compensated) {
    phasor_.assign(radar.transmitters.size() * map.velocity.size(), 1.0);
    return;
  }
  phasor_ = slot_phasors(radar, map.velocity);
  carrier_ = carrier_phasors(radar, map.range);
}

Complex ElementReader::weight(int64_t entry, int64_t velocity, double fold) const {
  if (!compensate_) return 1.0;
  const int64_t slot = channel_[entry] / map_.num_receivers;
  const double turns = std::fmod(fold * turns_of_fold_[slot], 1.0);
  return phasor_[slot * num_velocities_ + velocity] * std::polar(1.0, -kTwoPi * turns);
}

Complex ElementReader::carrier(int64_t channel, int64_t range, const EchoPlace& echo) const {
  if (turns_of_carrier_.empty()) return 1.0;
  const int64_t slot = channel / map_.num_receivers;
  if (!echo.range) return carrier_.empty() ? 1.0 : carrier_[slot * num_ranges_ + range];
  const double taken_out = map_.is_tdm_compensated ? map_.range[range] : 0.0;
  return std::polar(1.0, -turns_of_carrier_[slot] * (*echo.range - taken_out));
}

void ElementReader::read(int64_t velocity, int64_t first, int64_t count, Eigen::Ref<Eigen::MatrixXcd> values,
                         const EchoPlace& echo) const {
  const bool has_carriers = !turns_of_carrier_.empty();
  for (int64_t element = 0; element < num_elements(); ++element) {
    const double share = 1.0 / static_cast<double>(first_[element + 1] - first_[element]);
    for (int64_t entry = first_[element]; entry < first_[element + 1]; ++entry) {
      const int64_t channel = channel_[entry];
      const Complex factor = share * weight(entry, velocity, echo.fold);
      const Complex* row = map_.values.data() + (channel * num_velocities_ + velocity) * num_ranges_ + first;
      const bool is_first = entry == first_[element];
      for (int64_t i = 0; i < count; ++i) {
        const Complex value = has_carriers ? factor * carrier(channel, first + i, echo) * row[i] : factor * row[i];
        values(element, i) = is_first ? value : values(element, i) + value;
      }
    }
  }
}

Eigen::VectorXcd ElementReader::channel_weights(int64_t velocity, int64_t range, const Eigen::VectorXcd& of_elements) const {
  Eigen::VectorXcd weights = Eigen::VectorXcd::Zero(map_.num_transmitters * map_.num_receivers);
  for (int64_t element = 0; element < num_elements(); ++element) {
    const double share = 1.0 / static_cast<double>(first_[element + 1] - first_[element]);
    for (int64_t entry = first_[element]; entry < first_[element + 1]; ++entry) {
      const int64_t channel = channel_[entry];
      weights[channel] = of_elements[element] * share * weight(entry, velocity, 0.0) * carrier(channel, range, {});
    }
  }
  return weights;
}

}  // namespace echopath
