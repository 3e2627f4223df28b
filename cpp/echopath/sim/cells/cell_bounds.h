#pragma once
// Bounds the power of groups of paths in the cells of a range-Doppler map from the delays and amplitudes of their echoes,
// without their signals.
//
// Windows divide by their sum, so that an echo of amplitude A and beat frequency x (in cells) gives at most A |W(r - x)|
// in a cell at range r, whatever its velocity; fields add at best in phase. So at every velocity
//   power of a group at r <= (sum over its echoes of max A  max |W(r - x)|)^2,
// with the maxima over chirps and channels. Means over channels and Bartlett beams, whose weights add up to 1, are no
// larger.
#include <cstdint>
#include <span>
#include <vector>

#include "echopath/radar/radar.h"
#include "echopath/signal/echoes/echoes.h"
#include "echopath/signal/kernels/carrier.h"
#include "echopath/spectrum/window.h"

namespace echopath {

// Collects the largest amplitude of each path and the range of its beat frequencies, and bounds powers by them.
class CellBounds {
 public:
  // Echoes with the delay of every sample (`per_sample`) are not single tones: they are bounded by their amplitude alone, at
  // every range.
  CellBounds(int64_t num_paths, const Radar& radar, bool per_sample);

  // Takes the blocks of a channel; `first` tells the path of each echo, or the first of those joined in it. It looks at
  // about kChirps chirps of the frame. Bounds allow for amplitudes between these chirps that are larger by the factor
  // kSpare, and for beat frequencies that are off by a quarter of a cell.
  void see(std::span<const Echoes> blocks, std::span<const int64_t> first);
  static constexpr int kChirps = 8;
  static constexpr double kSpare = 1.05;

  // Returns bounds of the power of each group, [num_groups, R] in W. `group` [P] names the group of each path; paths of
  // group `num_groups` and above are left out.
  std::vector<double> bounds(std::span<const uint32_t> group, uint32_t num_groups, const Window& window, int zero_pad) const;

 private:
  void see_some(const Echoes& block, int chirp, int64_t begin, int count, const int64_t* first);

  ChirpSequence waveform_;
  CarrierModel model_;
  bool per_sample_;
  // These hold, by path, the largest amplitude in sqrt(W) and the lowest and highest beat frequency in cells.
  std::vector<float> amplitude_, lowest_, highest_;
};

}  // namespace echopath
