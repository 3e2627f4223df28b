#pragma once
// What amplitudes ask of the radar and of the settings of a replay.
#include "echopath/replay/kernels/cell_formula.h"
#include "echopath/trace/record/paths.h"

namespace echopath {

struct RadioConstants {
  double transmit_power;  // W
  double wavelength;      // m, at the start frequency
  double wavenumber;      // rad/m
  Footprint footprint = Footprint::kSecondOrder;
  double spread = 0.65;  // of a launch cell (trace/launch/sampler.h)
  CellView cells;

  CellFilter filter() const { return {wavenumber, spread, footprint, cells}; }
  // What of the amplitude (path_formula.h) is the same for all paths of a kind: of coherent ones in sqrt(W), of diffuse ones and
  // of those over mirrors alone in sqrt(W) m.
  double coherent_scale() const;
  double diffuse_scale() const;
  double mirror_scale() const { return wavelength * coherent_scale(); }
};

// Those of a record played back with `radar`.
RadioConstants radio_constants(const Paths& paths, const Radar& radar);

}  // namespace echopath
