#include "echopath/validity/validity_objects.h"

#include "echopath/base/constants.h"
#include "echopath/base/lanes/phasor.h"

namespace echopath {

BandSum::Band::Band(const ChirpSequence& waveform)
    : first((waveform.start_frequency + 0.5 * waveform.bandwidth / kFrequencies) / kSpeedOfLight),
      step(waveform.bandwidth / kFrequencies / kSpeedOfLight) {}

void BandSum::add(const Echo& echo, bool is_field, double weight, const Band& band) {
  if (!is_field) {
    power_ += weight * std::norm(echo.amplitude);
    return;
  }
  const Phasor first = phasor_of_product(band.first, echo.length), step = phasor_of_product(band.step, echo.length);
  std::complex<double> value = weight * echo.amplitude * std::complex<double>(first.re, -first.im);
  const std::complex<double> turn(step.re, -step.im);
  for (std::complex<double>& sum : field_) {
    sum += value;
    value *= turn;
  }
}

void BandSum::add(const BandSum& other, double sign) {
  power_ += sign * other.power_;
  for (size_t i = 0; i < kFrequencies; ++i) field_[i] += sign * other.field_[i];
}

double BandSum::power() const {
  double sum = power_;
  for (const std::complex<double>& value : field_) sum += std::norm(value) / kFrequencies;
  return sum;
}

void ObjectAtTime::add(const ObjectAtTime& other) {
  replayed.add(other.replayed);
  lost.add(other.lost);
  fresh.add(other.fresh);
  edges.add(other.edges);
}

double ObjectAtTime::true_power() const {
  BandSum sum = replayed;
  sum.add(lost, -1.0);
  sum.add(fresh);
  sum.add(edges);
  return sum.power();
}

void add(const ObjectsAtTimes& other, ObjectsAtTimes& sum) {
  for (const auto& [object, times] : other) {
    std::vector<ObjectAtTime>& own = sum[object];
    own.resize(times.size());
    for (size_t i = 0; i < times.size(); ++i) own[i].add(times[i]);
  }
}

}  // namespace echopath
