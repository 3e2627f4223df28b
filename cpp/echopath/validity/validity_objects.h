#pragma once
// Compares what a replay makes of each object at each time of a check with what is there.
#include <array>
#include <map>
#include <vector>

#include "echopath/validity/frame/frame_check.h"

namespace echopath {

// Sums the power of paths. Physical-optics paths add up as fields over some frequencies of the band, the others as powers.
class BandSum {
 public:
  static constexpr size_t kFrequencies = 16;
  struct Band {
    explicit Band(const ChirpSequence& waveform);
    double first, step;  // cycles per m of length
  };
  void add(const Echo& echo, bool is_field, double weight, const Band& band);
  void add(const BandSum& other, double sign = 1.0);
  double power() const;  // W, mean over the band

 private:
  double power_ = 0.0;                                      // W
  std::array<std::complex<double>, kFrequencies> field_{};  // sqrt(W)
};

struct ObjectAtTime {
  BandSum replayed, lost;  // recorded paths: all, and those that are no longer there
  BandSum fresh;           // paths on new surface
  BandSum edges;           // what recorded paths would have more with what edges of planes leave of them at the time

  void add(const ObjectAtTime& other);
  double true_power() const;  // W, of what is left and what is new together
};

// Holds sums by object (node index) and time of the check.
using ObjectsAtTimes = std::map<size_t, std::vector<ObjectAtTime>>;
void add(const ObjectsAtTimes& other, ObjectsAtTimes& sum);

}  // namespace echopath
