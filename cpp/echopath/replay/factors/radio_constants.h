#pragma once
// Holds the constants of the radar and of the replay settings that amplitudes depend on.
#include "echopath/record/paths.h"
#include "echopath/replay/kernels/cell_formula.h"

namespace echopath {

struct RadioConstants {
  double transmit_power;  // W
  double wavelength;      // m, at the start frequency
  double wavenumber;      // rad/m
  Footprint footprint = Footprint::kSecondOrder;
  double spread = 0.65;  // of a launch cell (record/sampler.h)
  CellView cells;

  CellFilter filter() const { return {wavenumber, spread, footprint, cells}; }
  // Return the factor of the amplitude (path_formula.h) that all paths of a kind share: in sqrt(W) for coherent paths, in
  // sqrt(W) m for diffuse paths and for paths over mirrors alone.
  double coherent_scale() const;
  double diffuse_scale() const;
  double mirror_scale() const { return wavelength * coherent_scale(); }
};

// Returns the constants for a record that is played back with `radar`.
RadioConstants radio_constants(const Paths& paths, const Radar& radar);

}  // namespace echopath
