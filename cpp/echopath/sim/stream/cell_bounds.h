#pragma once
// Bounds what groups of paths can show in the cells of a map, from their echoes alone: no signal is needed.
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

class CellBounds {
 public:
  // Echoes taken with the delay of every sample (`per_sample`) are no tones: theirs are the same at every range.
  CellBounds(int64_t num_paths, const Radar& radar, bool per_sample);

  // Takes the blocks of a channel; `first` tells the path of each echo, or the first of those joined in it. Chirps are
  // looked at in kChirps places; between these amplitudes may be kSpare larger and beats a quarter of a cell off.
  void see(std::span<const Echoes> blocks, std::span<const int64_t> first);
  static constexpr int kChirps = 8;
  static constexpr double kSpare = 1.05;

  // Returns bounds of the power, [num_groups, R] in W; group [P], those of num_groups and above are left out.
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
