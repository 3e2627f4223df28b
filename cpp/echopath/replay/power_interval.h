#pragma once
// The 95 % interval of a received power: what the launch cells take away and what chance adds, together.
#include <complex>
#include <cstdint>

#include "echopath/replay/cell_formula.h"

namespace echopath {

// Sides of launch cells, relative to those of the trace, at which the coherent field is looked at: as launched, a little
// finer, those of half as many rays, none at all (no filter), and what cells as launched may hide.
inline constexpr double kCellSides[] = {1.0, 0.8, 1.4142135623730951, 0.0, CellFilter::kHidden};
enum CellSide { kAsLaunched, kFiner, kHalfDensity, kUnfiltered, kHidden, kNumCellSides };

// What a set of paths is known by, of all rays.
struct PowerEvidence {
  double coherent = 0.0, diffuse = 0.0;       // W, the estimates
  std::complex<double> field[kNumCellSides];  // sqrt(W), of the coherent paths
  double coherent_power[kNumCellSides] = {};  // W, sum of |a|^2 over them
  double hidden_squares = 0.0;                // W^2, sum of |a|^4 of what cells may hide
  // Of the coherent paths that hardly change at half the density, such as those of flat surfaces up to their edges: W, sum of
  // their |a|^2, and W^2, of its squares.
  double steady_power = 0.0, steady_squares = 0.0;
  double lattice_squares = 0.0;               // W^2, sum of squares of the powers of diffuse hits that the launch lattice found
  double drawn_squares = 0.0;                 // W^2, of those that were found by directions drawn at random
  int num_batches = 1;
  double standard_error = 0.0;                // W, of coherent + diffuse by the batches; of no interest for one
};

struct PowerInterval {
  double low = 0.0, high = 0.0;  // W
  double bias = 0.0;             // W, by which the coherent power may change with finer launch cells
  double chance = 0.0;           // W, standard error of the power; of one batch estimated from the record
};

// Bias: the footprint filter of cells sqrt(2) wider says how fast the coherent field F goes with the cells. With d its change
// relative to |F|, the field may be off by kOfHalving d |F| where d is small; where it is not, cells are far too wide, and what
// finer ones will find grows to several times the change (kOfHalvingMore). A filter that takes all away is no evidence at all:
// then the field may be as large as what the cells may hide, in random phase: points of reflection between rays that met the surface
// near them, and edges; if these are many alike, no more than kEdgeCells sqrt(n) of n cells lie at one. Cells a little finer tell where the filter takes edges
// for a surface without end; what is below kAliases there is the lattice showing through.
// Chance: Student's t of the batches, and no less than half a hit in each of them. Of one batch: directions drawn at random give the variance sum p^2; a lattice errs along
// the outline of what it meets alone, so that its variance is kOutline^2 sum p^2 / sqrt(n) over n equal hits, and likewise for
// fields: less so where the filter takes much away, as fields of curved surfaces fade toward their outline. The factors are fitted to the coverage of `echopath bench coverage`.
PowerInterval power_interval(const PowerEvidence& evidence);

// Student's t: two-sided 95 % quantile.
double student_t95(int degrees_of_freedom);

}  // namespace echopath
